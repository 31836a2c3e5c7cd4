#include "collision/problem/checked_pairs.h"

#include <algorithm>

#include "collision/problem/padding.h"

// Each body has a row of the allowed collision matrix. All objects without an entry in the matrix share one look-up for
// each body. Own method. The rules for attached objects are those of MoveIt, with one exception: an attached object is
// never checked against the link that carries it.
namespace gpu_planning_scene::core
{
namespace
{
/// Whether `attached` may touch the link: the link carries it, or is one of its touch links.
bool mayTouch(const AttachedObject& attached, int link)
{
  return link == attached.link ||
         std::find(attached.touch_links.begin(), attached.touch_links.end(), link) != attached.touch_links.end();
}

/// Whether a pair is never checked because of an attached object: an attached object with its link or one of its touch
/// links, or two objects attached to the same link.
bool touchByCarrying(const RobotBody& a, const RobotBody& b)
{
  if (a.attached && b.attached)
    return a.link == b.link;
  if (a.attached)
    return mayTouch(*a.attached, b.link);
  return b.attached && mayTouch(*b.attached, a.link);
}
}  // namespace

std::vector<RobotBody> robotBodies(const PlanningScene& scene)
{
  const auto& links = scene.robot->links();
  std::vector<RobotBody> bodies;
  int body = 0;
  for (const Link& link : links)
  {
    if (!link.shapes.empty())
      bodies.push_back(
          {body, body, &link.name, &link.shapes, Eigen::Isometry3d::Identity(), paddingOf(scene, body), nullptr});
    ++body;
  }
  body += static_cast<int>(scene.objects.size());
  for (const AttachedObject& attached : scene.attached)
  {
    const WorldObject& object = attached.object;
    if (!object.shapes.empty())
      bodies.push_back(
          {body, attached.link, &object.id, &attached.shapes(), object.pose, paddingOf(scene, attached), &attached});
    ++body;
  }
  return bodies;
}

std::size_t countMoved(const std::vector<CheckedPair>& pairs)
{
  return static_cast<std::size_t>(std::count_if(
      pairs.begin(), pairs.end(), [](const CheckedPair& pair) { return pair.moved; }));
}

CheckedPairs findCheckedPairs(const PlanningScene& scene, const std::vector<RobotBody>& bodies,
                              const std::vector<bool>& moved, SceneReport& report)
{
  const auto& links = scene.robot->links();
  report.links_without_shapes = static_cast<std::size_t>(
      std::count_if(links.begin(), links.end(), [](const Link& link) { return link.shapes.empty(); }));
  const AllowedCollisionMatrix& matrix = scene.allowed_collisions;
  std::vector<AllowedCollisionMatrix::Row> body_rows;
  std::vector<AllowedCollisionMatrix::Row> object_rows;
  for (const RobotBody& body : bodies)
    body_rows.push_back(matrix.row(*body.name));
  for (const WorldObject& object : scene.objects)
    object_rows.push_back(matrix.row(object.id));
  // The allowed collision matrix has no entry for most objects; all of them have the same verdict for a body.
  struct Solid
  {
    std::uint32_t object;
    bool known;
  };
  std::vector<Solid> solids;
  for (std::uint32_t k = 0; k < scene.objects.size(); ++k)
    if (!scene.objects[k].shapes.empty())
      solids.push_back({k, object_rows[k].known()});
  const AllowedCollisionMatrix::Row unknown;
  const auto count = static_cast<std::uint32_t>(bodies.size());
  CheckedPairs pairs;
  pairs.world.resize(bodies.size() * solids.size());
  CheckedPair* world_end = pairs.world.data();
  for (std::uint32_t i = 0; i < count; ++i)
  {
    const AllowedCollisionMatrix::Row& row = body_rows[i];
    for (std::uint32_t j = i + 1; j < count; ++j)
    {
      if (touchByCarrying(bodies[i], bodies[j]))
      {
        ++report.touch_pairs;
        continue;
      }
      const bool is_allowed = row.allowed(body_rows[j]);
      const bool is_moved = moved[bodies[i].link] || moved[bodies[j].link];
      ++(is_allowed ? report.allowed_self_pairs : is_moved ? report.self_pairs : report.pairs_outside_group);
      if (!is_allowed)
        pairs.self.push_back({i, j, is_moved});
    }
    const bool is_moved = moved[bodies[i].link];
    const bool unknown_allowed = row.allowed(unknown);
    const CheckedPair* const first = world_end;
    for (const Solid& solid : solids)
    {
      *world_end = {i, solid.object, is_moved};
      world_end += (solid.known ? row.allowed(object_rows[solid.object]) : unknown_allowed) ? 0 : 1;
    }
    const auto checked = static_cast<std::size_t>(world_end - first);
    report.allowed_world_pairs += solids.size() - checked;
    (is_moved ? report.world_pairs : report.pairs_outside_group) += checked;
  }
  pairs.world.resize(static_cast<std::size_t>(world_end - pairs.world.data()));
  return pairs;
}
}  // namespace gpu_planning_scene::core
