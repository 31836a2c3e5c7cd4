#include "scene/changes/scene_count.h"

#include <algorithm>
#include <cctype>
#include <unordered_set>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kMostPostureNumbers = 10000;

/// "a link", "an object".
std::string withArticle(const std::string& noun)
{
  return (noun.find_first_of("aeiou") == 0 ? "an " : "a ") + noun;
}

void requireAtMost(std::size_t count, std::size_t limit, const std::string& what, const char* parameter)
{
  if (limit != 0 && count > limit)
    throw Error(what + " " + std::to_string(count) + "; the parameter limits/" + parameter + " allows " +
                std::to_string(limit));
}

const Mesh* meshOf(const PlacedShape& placed)
{
  const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape);
  return mesh == nullptr ? nullptr : mesh->get();
}
}  // namespace

SceneCount::SceneCount(const SceneLimits& limits, const PlanningScene& scene)
  : limits_(limits), objects_(scene.objects.size() + scene.attached.size())
{
  for (const WorldObject& object : scene.objects)
    shapes_ += object.shapes.size();
  for (const AttachedObject& attached : scene.attached)
    shapes_ += attached.object.shapes.size();
}

void SceneCount::add(const std::string& id, const std::vector<PlacedShape>& shapes)
{
  const std::string start = "object '" + id + "': ";
  requireAtMost(++objects_, limits_.objects, start + "objects would be", "objects");
  shapes_ += shapes.size();
  requireAtMost(shapes_, limits_.shapes, start + "shapes of all objects would be", "shapes");
  for (const PlacedShape& placed : shapes)
    if (const Mesh* mesh = meshOf(placed))
    {
      requireAtMost(mesh->triangles.size(), limits_.triangles_of_mesh, start + "the triangles of a mesh are",
                    "triangles_of_mesh");
      has_new_mesh_ = true;
    }
}

void SceneCount::remove(const std::vector<PlacedShape>& shapes)
{
  --objects_;
  shapes_ -= shapes.size();
}

void SceneCount::requireTriangles(const PlanningScene& scene) const
{
  if (!has_new_mesh_)
    return;
  std::unordered_set<const Mesh*> seen;
  std::size_t triangles = 0;
  const auto count = [&](const std::vector<PlacedShape>& shapes)
  {
    for (const PlacedShape& placed : shapes)
      if (const Mesh* mesh = meshOf(placed); mesh != nullptr && seen.insert(mesh).second)
        triangles += mesh->triangles.size();
  };
  for (const Link& link : scene.robot->links())
    count(link.shapes);
  for (const WorldObject& object : scene.objects)
    count(object.shapes);
  for (const AttachedObject& attached : scene.attached)
    count(attached.shapes());
  requireAtMost(triangles, limits_.triangles, "the scene's triangles would be", "triangles");
}

void SceneCount::requireFramesAndColors(const PlanningScene& scene) const
{
  std::size_t frames = scene.fixed_frames.size();
  for (const WorldObject& object : scene.objects)
    frames += object.subframes.size();
  for (const AttachedObject& attached : scene.attached)
    frames += attached.object.subframes.size();
  requireAtMost(frames, limits_.frames, "fixed frames and subframes would be", "frames");
  requireAtMost(scene.colors.size(), limits_.colors, "colors would be", "colors");
}

void SceneCount::requireName(const std::string& name, const std::string& what) const
{
  if (name.empty())
    throw Error(withArticle(what) + " has no name; give it a name");
  requireAtMost(name.size(), limits_.name_length, "the length of a name (" + what + ") is", "name_length");
  if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }))
    throw Error("the name of " + withArticle(what) + " contains a line break or another control character; remove it");
}

void SceneCount::requireType(const ObjectType& type, const std::string& where) const
{
  for (const std::string* text : {&type.key, &type.db})
    requireAtMost(text->size(), limits_.name_length, "the length of a type (" + where + ") is", "name_length");
}

void SceneCount::requirePosture(const JointTrajectory& posture, const std::string& where) const
{
  std::size_t numbers = posture.joint_names.size() + posture.points.size();
  for (const JointTrajectory::Point& point : posture.points)
    numbers += point.positions.size() + point.velocities.size() + point.accelerations.size() + point.effort.size();
  if (numbers > kMostPostureNumbers)
    throw Error(where + ": the detach_posture has " + std::to_string(numbers) + " names and numbers; at most " +
                std::to_string(kMostPostureNumbers) + " are allowed");
  requireAtMost(posture.frame_id.size(), limits_.name_length, "the length of a name (" + where + ") is", "name_length");
  for (const std::string& name : posture.joint_names)
    requireName(name, "joint of the detach_posture of " + where);
}

void SceneCount::requireVoxels(std::size_t count) const
{
  requireAtMost(count, limits_.voxels, "the occupied leaves of the octomap are", "voxels");
}

void SceneCount::requireMatrix(const AllowedCollisionMatrix& matrix) const
{
  const std::size_t width = matrix.bodiesWithEntries().size();
  for (const std::string& name : matrix.bodies())
    requireName(name, "body of the allowed-collision matrix");
  requireAtMost(width * width, limits_.matrix_entries, "the entries of the allowed-collision matrix are",
                "matrix_entries");
}
}  // namespace gpu_planning_scene::core
