#include "collision_problem.h"

#include <algorithm>
#include <map>

#include "primitive_solid.h"

namespace gpu_planning_scene
{
namespace
{
/// Equal for shapes that can share a tree: the same kind and dimensions, or the same mesh.
struct ShapeKey
{
  std::size_t kind;
  Eigen::Vector3d dimensions;
  const Mesh* mesh;

  bool operator<(const ShapeKey& other) const
  {
    return std::tie(kind, dimensions.x(), dimensions.y(), dimensions.z(), mesh) <
           std::tie(other.kind, other.dimensions.x(), other.dimensions.y(), other.dimensions.z(), other.mesh);
  }
};

ShapeKey keyOf(const Shape& shape)
{
  if (isMesh(shape))
  {
    return {shape.index(), Eigen::Vector3d::Zero(), std::get<std::shared_ptr<const Mesh>>(shape).get()};
  }
  // A primitive is known by its kind and extents.
  return {shape.index(), halfExtents(shape), nullptr};
}

/// Adds the trees of shapes to a problem, each distinct one once.
class TreeTable
{
 public:
  explicit TreeTable(CollisionProblem& problem) : problem_(problem) {}

  void addGeometries(const std::vector<PlacedShape>& shapes, int body, const Eigen::Isometry3d& pose,
                     std::vector<Geometry>& geometries)
  {
    for (const PlacedShape& placed : shapes)
    {
      geometries.push_back({treeOf(placed.shape), body, pose * placed.pose});
    }
  }

 private:
  std::uint32_t treeOf(const Shape& shape)
  {
    const auto [entry, is_new] = trees_.try_emplace(keyOf(shape), static_cast<std::uint32_t>(problem_.trees.size()));
    if (is_new)
    {
      problem_.trees.push_back(tessellate(shape));
      problem_.shapes.push_back(shape);
    }
    return entry->second;
  }

  CollisionProblem& problem_;
  std::map<ShapeKey, std::uint32_t> trees_;
};

/// The geometries of bodies with consecutive indices: those of body b are numbers [b - first_body] to [b - first_body +
/// 1].
std::vector<std::uint32_t> rangesOf(const std::vector<Geometry>& geometries, int first_body, std::size_t bodies)
{
  std::vector<std::uint32_t> ranges(bodies + 1, 0);
  for (const Geometry& geometry : geometries)
  {
    ++ranges[geometry.body - first_body + 1];
  }
  for (std::size_t i = 1; i < ranges.size(); ++i)
  {
    ranges[i] += ranges[i - 1];
  }
  return ranges;
}
}  // namespace

CollisionProblem makeProblem(const PlanningScene& scene, const std::string& group, SceneReport* report)
{
  const auto& links = scene.robot->links();
  const auto& objects = scene.objects;
  std::vector<bool> moved(links.size(), group.empty());
  if (!group.empty())
  {
    for (const int link : scene.robot->group(group).moved_links)
    {
      moved[link] = true;
    }
  }

  SceneReport counts;
  CollisionProblem problem;
  TreeTable trees(problem);
  for (std::size_t i = 0; i < links.size(); ++i)
  {
    trees.addGeometries(links[i].shapes, static_cast<int>(i), Eigen::Isometry3d::Identity(), problem.robot);
    counts.links_without_shapes += links[i].shapes.empty() ? 1 : 0;
  }
  const int first_object = static_cast<int>(links.size());
  for (std::size_t k = 0; k < objects.size(); ++k)
  {
    trees.addGeometries(objects[k].shapes, first_object + static_cast<int>(k), objects[k].pose, problem.world);
  }
  const std::vector<std::uint32_t> robot_ranges = rangesOf(problem.robot, 0, links.size());
  const std::vector<std::uint32_t> world_ranges = rangesOf(problem.world, first_object, objects.size());

  problem.world_pairs.assign(problem.robot.size() * problem.world.size(), 0);
  for (std::size_t i = 0; i < links.size(); ++i)
  {
    if (links[i].shapes.empty())
    {
      continue;
    }
    for (std::size_t j = i + 1; j < links.size(); ++j)
    {
      if (links[j].shapes.empty())
      {
        continue;
      }
      if (!moved[i] && !moved[j])
      {
        ++counts.unmoved_pairs;
        continue;
      }
      if (scene.allowed_collisions.allowed(links[i].name, links[j].name))
      {
        ++counts.allowed_self_pairs;
        continue;
      }
      ++counts.self_pairs;
      for (std::uint32_t a = robot_ranges[i]; a < robot_ranges[i + 1]; ++a)
      {
        for (std::uint32_t b = robot_ranges[j]; b < robot_ranges[j + 1]; ++b)
        {
          problem.self_pairs.push_back({a, b});
        }
      }
    }
    for (std::size_t k = 0; k < objects.size(); ++k)
    {
      if (objects[k].shapes.empty())
      {
        continue;
      }
      if (!moved[i])
      {
        ++counts.unmoved_pairs;
        continue;
      }
      if (scene.allowed_collisions.allowed(links[i].name, objects[k].id))
      {
        ++counts.allowed_world_pairs;
        continue;
      }
      ++counts.world_pairs;
      for (std::uint32_t a = robot_ranges[i]; a < robot_ranges[i + 1]; ++a)
      {
        const auto row = problem.world_pairs.begin() + a * problem.world.size();
        std::fill(row + world_ranges[k], row + world_ranges[k + 1], std::uint8_t{1});
      }
    }
  }
  counts.trees = problem.trees.size();
  for (const Tessellation& tree : problem.trees)
  {
    counts.triangles += tree.mesh->triangles.size();
  }
  if (report != nullptr)
  {
    *report = counts;
  }
  return problem;
}
}  // namespace gpu_planning_scene
