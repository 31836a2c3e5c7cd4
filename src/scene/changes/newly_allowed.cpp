#include "scene/changes/newly_allowed.h"

#include <algorithm>
#include <vector>

namespace gpu_planning_scene::core
{
namespace
{
/// A body with its rows of both matrices.
struct Rows
{
  Rows(const std::string& body, const AllowedCollisionMatrix& matrix_before, const AllowedCollisionMatrix& matrix_after)
    : name(&body), before(matrix_before.row(body)), after(matrix_after.row(body))
  {
  }
  const std::string* name;
  AllowedCollisionMatrix::Row before;
  AllowedCollisionMatrix::Row after;
};

bool isNewlyAllowed(const Rows& a, const Rows& b)
{
  return a.after.allowed(b.after) && !a.before.allowed(b.before);
}
}  // namespace

NewlyAllowed findNewlyAllowed(const PlanningScene& scene, const AllowedCollisionMatrix& before)
{
  NewlyAllowed found;
  const AllowedCollisionMatrix& after = scene.allowed_collisions;
  if (after == before)
    return found;
  const auto add = [&found](const Rows& a, const Rows& b, std::size_t pairs)
  {
    if (found.pairs == 0 && pairs != 0)
    {
      found.body_1 = *a.name;
      found.body_2 = *b.name;
    }
    found.pairs += pairs;
  };
  const auto& all_links = scene.robot->links();
  std::vector<Rows> links;
  std::vector<int> link_numbers;
  for (std::size_t i = 0; i < all_links.size(); ++i)
    if (!all_links[i].shapes.empty())
    {
      links.emplace_back(all_links[i].name, before, after);
      link_numbers.push_back(static_cast<int>(i));
    }
  for (std::size_t i = 0; i < links.size(); ++i)
    for (std::size_t j = i + 1; j < links.size(); ++j)
      add(links[i], links[j], isNewlyAllowed(links[i], links[j]) ? 1 : 0);
  // Objects that no matrix names are alike, so one stands for all of them: a scene may have 100,000.
  std::vector<Rows> unnamed;
  std::size_t unnamed_count = 0;
  for (const WorldObject& object : scene.objects)
  {
    const Rows rows(object.id, before, after);
    if (rows.before.known() || rows.after.known())
      for (const Rows& link : links)
        add(link, rows, isNewlyAllowed(link, rows) ? 1 : 0);
    else if (unnamed_count++ == 0)
      unnamed.push_back(rows);
  }
  for (const Rows& rows : unnamed)
    for (const Rows& link : links)
      add(link, rows, isNewlyAllowed(link, rows) ? unnamed_count : 0);
  for (const AttachedObject& attached : scene.attached)
  {
    const Rows rows(attached.object.id, before, after);
    for (std::size_t i = 0; i < links.size(); ++i)
    {
      const std::vector<int>& touching = attached.touch_links;
      const bool touches = link_numbers[i] == attached.link ||
                           std::find(touching.begin(), touching.end(), link_numbers[i]) != touching.end();
      add(links[i], rows, !touches && isNewlyAllowed(links[i], rows) ? 1 : 0);
    }
  }
  return found;
}
}  // namespace gpu_planning_scene::core
