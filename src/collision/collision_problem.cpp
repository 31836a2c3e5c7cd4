#include "collision_problem.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "gpu_planning_scene/error.h"
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
      geometries.push_back({treeOf(placed.shape), body, body, pose * placed.pose});
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

/// Objects may come from a program as well as from a file. (A robot is checked when it is loaded.)
void validateObjects(const PlanningScene& scene)
{
  std::set<std::string> ids;
  for (const WorldObject& object : scene.objects)
  {
    const std::string where = "object '" + object.id + "'";
    if (!ids.insert(object.id).second)
    {
      throw Error(where + ": there is another object of that name; give each its own");
    }
    const auto validate_pose = [&where](const Eigen::Isometry3d& pose)
    {
      const Eigen::Matrix3d& r = pose.linear();
      if (!pose.matrix().allFinite() || !(r * r.transpose()).isIdentity(1e-6) || r.determinant() < 0.0)
      {
        throw Error(where + ": a pose is not finite or not a rotation and a translation");
      }
    };
    validate_pose(object.pose);
    for (const PlacedShape& placed : object.shapes)
    {
      validate_pose(placed.pose);
      validateShape(placed.shape, where);
    }
  }
}

struct BodyPair
{
  std::size_t link;   // index of a link
  std::size_t other;  // index of a later link, or of an object
};

/// The pairs that the allowed-collision matrix leaves, whatever the group. Bodies without shapes are in none.
struct CheckedPairs
{
  std::vector<BodyPair> self;
  std::vector<BodyPair> world;
};

CheckedPairs findCheckedPairs(const PlanningScene& scene, const std::vector<bool>& moved, SceneReport& report)
{
  const auto& links = scene.robot->links();
  CheckedPairs pairs;
  for (std::size_t i = 0; i < links.size(); ++i)
  {
    if (links[i].shapes.empty())
    {
      ++report.links_without_shapes;
      continue;
    }
    for (std::size_t j = i + 1; j < links.size(); ++j)
    {
      if (links[j].shapes.empty())
      {
        continue;
      }
      const bool is_allowed = scene.allowed_collisions.allowed(links[i].name, links[j].name);
      const bool is_moved = moved[i] || moved[j];
      ++(is_allowed ? report.allowed_self_pairs : is_moved ? report.self_pairs : report.unmoved_pairs);
      if (!is_allowed)
      {
        pairs.self.push_back({i, j});
      }
    }
    for (std::size_t k = 0; k < scene.objects.size(); ++k)
    {
      if (scene.objects[k].shapes.empty())
      {
        continue;
      }
      const bool is_allowed = scene.allowed_collisions.allowed(links[i].name, scene.objects[k].id);
      ++(is_allowed ? report.allowed_world_pairs : moved[i] ? report.world_pairs : report.unmoved_pairs);
      if (!is_allowed)
      {
        pairs.world.push_back({i, k});
      }
    }
  }
  return pairs;
}

/// A half-open range of indices of geometries.
struct Range
{
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};
}  // namespace

bool sameShape(const Shape& a, const Shape& b)
{
  const ShapeKey key_a = keyOf(a);
  const ShapeKey key_b = keyOf(b);
  return !(key_a < key_b) && !(key_b < key_a);
}

CollisionProblem makeProblem(const PlanningScene& scene, const std::string& group, SceneReport* report)
{
  validateObjects(scene);
  const auto& links = scene.robot->links();
  std::vector<bool> moved(links.size(), group.empty());
  if (!group.empty())
  {
    for (const int link : scene.robot->group(group).moved_links)
    {
      moved[link] = true;
    }
  }
  SceneReport counts;
  const CheckedPairs pairs = findCheckedPairs(scene, moved, counts);
  std::vector<bool> link_needed(links.size(), false);
  std::vector<bool> object_needed(scene.objects.size(), false);
  for (const BodyPair& pair : pairs.self)
  {
    link_needed[pair.link] = link_needed[pair.other] = true;
  }
  for (const BodyPair& pair : pairs.world)
  {
    link_needed[pair.link] = object_needed[pair.other] = true;
  }

  CollisionProblem problem;
  TreeTable trees(problem);
  const auto add_body = [&trees](const std::vector<PlacedShape>& shapes, std::size_t body,
                                 const Eigen::Isometry3d& pose, std::vector<Geometry>& geometries)
  {
    const auto begin = static_cast<std::uint32_t>(geometries.size());
    trees.addGeometries(shapes, static_cast<int>(body), pose, geometries);
    return Range{begin, static_cast<std::uint32_t>(geometries.size())};
  };
  std::vector<Range> of_link(links.size());
  for (std::size_t i = 0; i < links.size(); ++i)
  {
    if (link_needed[i])
    {
      of_link[i] = add_body(links[i].shapes, i, Eigen::Isometry3d::Identity(), problem.robot);
    }
  }
  std::vector<Range> of_object(scene.objects.size());
  for (std::size_t k = 0; k < scene.objects.size(); ++k)
  {
    const WorldObject& object = scene.objects[k];
    if (object_needed[k])
    {
      of_object[k] = add_body(object.shapes, links.size() + k, object.pose, problem.world);
    }
  }

  for (const BodyPair& pair : pairs.self)
  {
    if (!moved[pair.link] && !moved[pair.other])
    {
      continue;
    }
    for (std::uint32_t a = of_link[pair.link].begin; a < of_link[pair.link].end; ++a)
    {
      for (std::uint32_t b = of_link[pair.other].begin; b < of_link[pair.other].end; ++b)
      {
        problem.self_pairs.push_back({a, b});
      }
    }
  }
  problem.world_pairs.assign(problem.robot.size() * problem.world.size(), 0);
  for (const BodyPair& pair : pairs.world)
  {
    if (!moved[pair.link])
    {
      continue;
    }
    for (std::uint32_t a = of_link[pair.link].begin; a < of_link[pair.link].end; ++a)
    {
      const auto row = problem.world_pairs.begin() + a * problem.world.size();
      std::fill(row + of_object[pair.other].begin, row + of_object[pair.other].end, std::uint8_t{1});
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
