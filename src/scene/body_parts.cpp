#include "gpu_planning_scene/body_parts.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <set>

namespace gpu_planning_scene::core
{
namespace
{
std::string metres(double length)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.2g m", length);
  return text;
}

std::string percent(double share)
{
  char text[32];
  // Two digits of 99.5 and more would be 1e+02.
  std::snprintf(text, sizeof text, share < 0.995 ? "%.2g %%" : "%.0f %%", 100.0 * share);
  return text;
}

std::string counted(std::size_t count, const char* noun)
{
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string kindOfBody(const PlanningScene& scene, int body)
{
  const auto links = static_cast<int>(scene.robot->links().size());
  if (body < links)
    return "link";
  return body < links + static_cast<int>(scene.objects.size()) ? "object" : "attached object";
}

/// The parts of one mesh of a body that are of one kind, in one line.
std::string lineFor(const PlanningScene& scene, const std::vector<BodyPart>& parts)
{
  std::size_t triangles = 0;
  std::size_t holes = 0;
  double largest_hole = 0.0;
  double share = 0.0;
  for (const BodyPart& entry : parts)
  {
    triangles += entry.part.triangles;
    holes += entry.part.holes;
    largest_hole = std::max(largest_hole, entry.part.largest_hole);
    share = std::max(share, entry.part.hole_share);
  }
  const std::string where = kindOfBody(scene, parts.front().body) + " '" + scene.bodyName(parts.front().body) +
                            "', mesh '" + parts.front().mesh + "': ";
  const std::string what = counted(holes, "hole") + " of up to " + metres(largest_hole);
  if (parts.front().part.kind == PartKind::Filled)
    return where + what + (holes == 1 ? " is" : " are") + " filled (up to " + percent(share) + " of a part's area)";
  if (holes == 0 && share == 0.0)
    return where + "is a surface, as the rule 'surface' demands; a body inside it does not collide";
  if (holes == 0)
    return where + counted(parts.size(), "part") + " with " + counted(triangles, "triangle") +
           (parts.size() == 1 ? " is" : " are") +
           " only a surface: the cracks are too wide to be joined. A body inside does not collide; `solid: filled` "
           "joins them";
  return where + counted(parts.size(), "part") + " with " + counted(triangles, "triangle") +
         (parts.size() == 1 ? " is" : " are") + " only a surface: " + what + " (" + percent(share) +
         " of the area; at most " + percent(kSmallHoles) +
         " is filled). A body inside does not collide; `solid: filled` fills the holes";
}
}  // namespace

std::vector<BodyPart> openParts(const PlanningScene& scene)
{
  std::vector<BodyPart> parts;
  const auto add = [&](int body, const std::vector<PlacedShape>& shapes)
  {
    std::set<const Mesh*> seen;
    for (const PlacedShape& placed : shapes)
    {
      const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape);
      if (!mesh || !seen.insert(mesh->get()).second)
        continue;
      const auto solid = solidMeshOf(*mesh);
      for (const MeshPart& part : solid->parts.other)
        parts.push_back({body, (*mesh)->name, part});
    }
  };
  int body = 0;
  for (const Link& link : scene.robot->links())
    add(body++, link.shapes);
  for (const WorldObject& object : scene.objects)
    add(body++, object.shapes);
  for (const AttachedObject& attached : scene.attached)
    add(body++, attached.shapes());
  return parts;
}

std::vector<std::string> describeOpenParts(const PlanningScene& scene)
{
  const std::vector<BodyPart> parts = openParts(scene);
  std::vector<std::string> lines;
  for (auto first = parts.begin(); first != parts.end();)
  {
    const auto last =
        std::find_if(first, parts.end(),
                     [&](const BodyPart& entry) { return entry.body != first->body || entry.mesh != first->mesh; });
    for (const PartKind kind : {PartKind::Filled, PartKind::Surface})
    {
      std::vector<BodyPart> chosen;
      std::copy_if(first, last, std::back_inserter(chosen),
                   [kind](const BodyPart& entry) { return entry.part.kind == kind; });
      if (!chosen.empty())
        lines.push_back(lineFor(scene, chosen));
    }
    first = last;
  }
  return lines;
}
}  // namespace gpu_planning_scene::core
