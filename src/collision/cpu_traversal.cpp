#include "cpu_traversal.h"

#include <algorithm>

#include "cpu_box_pair.h"
#include "curved_pair.h"
#include "primitive_solid.h"

namespace gpu_planning_scene
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Boxes are grown by this much, so that neither rounding in the box tests nor the contact tolerance loses a touching
// pair.
constexpr double kBoxMargin = 1e-9;  // metres

constexpr std::uint32_t kWorldLeafSize = 2;

Vector3d centerOf(const Node& node)
{
  return {node.center[0], node.center[1], node.center[2]};
}
Vector3d halfOf(const Node& node)
{
  return {node.half[0], node.half[1], node.half[2]};
}
}  // namespace

CpuTraversal::CpuTraversal(std::shared_ptr<const CollisionProblem> problem, std::shared_ptr<const Forest> forest)
  : problem_(std::move(problem)), forest_(std::move(forest))
{
  for (std::size_t tree = 0; tree < problem_->trees.size(); ++tree)
  {
    const Shape& shape = problem_->shapes[tree];
    const Node& root = forest_->nodes[forest_->roots[tree]];
    // The box of a tessellation may be smaller than the solid.
    trees_.push_back({forest_->roots[tree], isMesh(shape) ? centerOf(root) : Vector3d::Zero(),
                      isMesh(shape) ? halfOf(root) : halfExtents(shape), isMesh(shape), problem_->trees[tree].sagitta});
  }

  const auto& first_triangle = forest_->first_triangle;
  triangles_.reserve(forest_->leaf_triangles.size());
  for (const std::uint32_t number : forest_->leaf_triangles)
  {
    const auto after = std::upper_bound(first_triangle.begin(), first_triangle.end(), number);
    const std::size_t tree = after - first_triangle.begin() - 1;
    const Mesh& mesh = *problem_->trees[tree].mesh;
    const auto& corners = mesh.triangles[number - first_triangle[tree]];
    triangles_.push_back({mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]});
  }

  for (const Geometry& object : problem_->world)
  {
    world_bounds_.push_back(boundsOf(object.tree, object.pose));
  }
  world_tree_ = buildBinnedSah(world_bounds_, kWorldLeafSize);
}

AlignedBox3d CpuTraversal::boundsOf(std::uint32_t tree, const Isometry3d& pose) const
{
  const Vector3d center = pose * trees_[tree].center;
  const Vector3d half = (pose.linear().cwiseAbs() * trees_[tree].half).array() + kBoxMargin;
  return {center - half, center + half};
}

void CpuTraversal::findNearObjects(const AlignedBox3d& bounds, Scratch& scratch) const
{
  scratch.near_objects.clear();
  if (world_tree_.nodes.empty())
  {
    return;
  }
  const Vector3d center = bounds.center();
  const Vector3d half = 0.5 * bounds.sizes();
  scratch.nodes.assign(1, 0u);
  while (!scratch.nodes.empty())
  {
    const Node& node = world_tree_.nodes[scratch.nodes.back()];
    scratch.nodes.pop_back();
    if (((centerOf(node) - center).cwiseAbs().array() > (halfOf(node) + half).array()).any())
    {
      continue;
    }
    if (node.count == 0)
    {
      scratch.nodes.push_back(node.first);
      scratch.nodes.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    {
      const std::uint32_t object = world_tree_.order[i];
      if (world_bounds_[object].intersects(bounds))
      {
        scratch.near_objects.push_back(object);
      }
    }
  }
}

template <class Visit>
void CpuTraversal::visitCollisions(const Isometry3d* link_poses, Scratch& scratch, const Visit& visit) const
{
  const auto& robot = problem_->robot;
  scratch.poses.resize(robot.size());
  scratch.bounds.resize(robot.size());
  for (std::size_t i = 0; i < robot.size(); ++i)
  {
    scratch.poses[i] = link_poses[robot[i].link] * robot[i].pose;
    scratch.bounds[i] = boundsOf(robot[i].tree, scratch.poses[i]);
  }
  for (std::size_t i = 0; i < robot.size(); ++i)
  {
    findNearObjects(scratch.bounds[i], scratch);
    for (const std::uint32_t object : scratch.near_objects)
    {
      const Geometry& other = problem_->world[object];
      if (problem_->world_pairs[i * problem_->world.size() + object] != 0 &&
          shapesMeet(robot[i].tree, scratch.poses[i], other.tree, other.pose, scratch) &&
          visit(BodyPair{robot[i].body, other.body}))
      {
        return;
      }
    }
  }
  for (const auto& [first, second] : problem_->self_pairs)
  {
    if (scratch.bounds[first].intersects(scratch.bounds[second]) &&
        shapesMeet(robot[first].tree, scratch.poses[first], robot[second].tree, scratch.poses[second], scratch) &&
        visit(BodyPair{robot[first].body, robot[second].body}))
    {
      return;
    }
  }
}

std::optional<CpuTraversal::BodyPair> CpuTraversal::firstCollision(const Isometry3d* link_poses, Scratch& scratch) const
{
  std::optional<BodyPair> found;
  visitCollisions(link_poses, scratch,
                  [&found](const BodyPair& pair)
                  {
                    found = pair;
                    return true;
                  });
  return found;
}

std::vector<CpuTraversal::BodyPair> CpuTraversal::allCollisions(const Isometry3d* link_poses, Scratch& scratch) const
{
  std::vector<BodyPair> found;
  visitCollisions(link_poses, scratch,
                  [&found](const BodyPair& pair)
                  {
                    found.push_back(pair);
                    return false;
                  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

bool CpuTraversal::shapesMeet(std::uint32_t a, const Isometry3d& pose_a, std::uint32_t b, const Isometry3d& pose_b,
                              Scratch& scratch) const
{
  const Isometry3d b_in_a = pose_a.inverse() * pose_b;
  const Vector3d grown = trees_[a].half.array() + kBoxMargin;
  const Vector3d between = b_in_a * trees_[b].center - trees_[a].center;
  if (!BoxPairTest(b_in_a.linear()).overlap(grown, trees_[b].half, between))
  {
    return false;
  }
  if (trees_[a].mesh && trees_[b].mesh)
  {
    return surfacesMeet(a, b, b_in_a, 0.0, scratch);
  }
  if (trees_[a].mesh)
  {
    return surfaceMeetsSolid(a, b, b_in_a, scratch);
  }
  if (trees_[b].mesh)
  {
    return surfaceMeetsSolid(b, a, b_in_a.inverse(), scratch);
  }
  return solidsMeet(a, b, b_in_a, scratch);
}

/// Two primitives whose bounding boxes overlap.
bool CpuTraversal::solidsMeet(std::uint32_t a, std::uint32_t b, const Isometry3d& b_in_a, Scratch& scratch) const
{
  const Shape& shape_a = problem_->shapes[a];
  const Shape& shape_b = problem_->shapes[b];
  const Vector3d center_of_a_in_b = b_in_a.inverse().translation();
  const bool box_a = std::holds_alternative<Box>(shape_a);
  const bool box_b = std::holds_alternative<Box>(shape_b);
  if (box_a && box_b)
  {
    const Vector3d grown = trees_[a].half.array() + kContactTolerance;
    return BoxPairTest(b_in_a.linear()).overlap(grown, trees_[b].half, b_in_a.translation());
  }
  if (const Sphere* sphere = std::get_if<Sphere>(&shape_a))
  {
    return distanceToSolid(shape_b, center_of_a_in_b) <= sphere->radius + kContactTolerance;
  }
  if (const Sphere* sphere = std::get_if<Sphere>(&shape_b))
  {
    return distanceToSolid(shape_a, b_in_a.translation()) <= sphere->radius + kContactTolerance;
  }
  // The tests of surfaces find all but one solid inside the other.
  if (distanceToSolid(shape_a, b_in_a.translation()) == 0.0 || distanceToSolid(shape_b, center_of_a_in_b) == 0.0)
  {
    return true;
  }
  if (box_a)
  {
    return surfaceMeetsSolid(a, b, b_in_a, scratch);
  }
  if (box_b)
  {
    return surfaceMeetsSolid(b, a, b_in_a.inverse(), scratch);
  }
  // Between the tessellations, which lie within the solids, and the true surfaces.
  return surfacesMeet(a, b, b_in_a, 0.0, scratch) ||
         (surfacesMeet(a, b, b_in_a, trees_[a].sagitta + trees_[b].sagitta, scratch) &&
          curvedSolidsMeet(shape_a, shape_b, b_in_a));
}

bool CpuTraversal::surfaceMeetsSolid(std::uint32_t a, std::uint32_t solid, const Isometry3d& solid_in_a,
                                     Scratch& scratch) const
{
  const Shape& shape = problem_->shapes[solid];
  const bool box = std::holds_alternative<Box>(shape);
  const Isometry3d a_in_solid = solid_in_a.inverse();
  const BoxPairTest pair_test(a_in_solid.linear());
  const Vector3d half_solid = trees_[solid].half.array() + kBoxMargin;

  scratch.nodes.assign(1, trees_[a].root);
  while (!scratch.nodes.empty())
  {
    const Node& node = forest_->nodes[scratch.nodes.back()];
    scratch.nodes.pop_back();
    const Vector3d half = halfOf(node);
    const Vector3d center = a_in_solid * centerOf(node);
    if (!pair_test.overlap(half_solid, half, center) ||
        (!box && distanceToSolid(shape, center) > half.norm() + kBoxMargin))
    {
      continue;
    }
    if (node.count == 0)
    {
      scratch.nodes.push_back(node.first);
      scratch.nodes.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    {
      const Triangle& t = triangles_[i];
      if (triangleMeetsSolid({a_in_solid * t[0], a_in_solid * t[1], a_in_solid * t[2]}, shape))
      {
        return true;
      }
    }
  }
  return false;
}

/// Simultaneous traversal: the pairs of overlapping nodes, of which the larger is opened.
bool CpuTraversal::surfacesMeet(std::uint32_t a, std::uint32_t b, const Isometry3d& b_in_a, double margin,
                                Scratch& scratch) const
{
  const BoxPairTest pair_test(b_in_a.linear());
  const Eigen::Array3d growth = Eigen::Array3d::Constant(margin + kBoxMargin);
  scratch.node_pairs.assign(1, {trees_[a].root, trees_[b].root});
  while (!scratch.node_pairs.empty())
  {
    const auto [index_a, index_b] = scratch.node_pairs.back();
    scratch.node_pairs.pop_back();
    const Node& node_a = forest_->nodes[index_a];
    const Node& node_b = forest_->nodes[index_b];
    const Vector3d half_a = halfOf(node_a).array() + growth;
    const Vector3d half_b = halfOf(node_b);
    if (!pair_test.overlap(half_a, half_b, b_in_a * centerOf(node_b) - centerOf(node_a)))
    {
      continue;
    }
    const bool leaf_a = node_a.count != 0;
    const bool leaf_b = node_b.count != 0;
    if (leaf_a && leaf_b)
    {
      if (leavesMeet(node_a, node_b, b_in_a, margin))
      {
        return true;
      }
    }
    else if (leaf_b || (!leaf_a && half_a.squaredNorm() >= half_b.squaredNorm()))
    {
      scratch.node_pairs.push_back({node_a.first, index_b});
      scratch.node_pairs.push_back({node_a.first + 1, index_b});
    }
    else
    {
      scratch.node_pairs.push_back({index_a, node_b.first});
      scratch.node_pairs.push_back({index_a, node_b.first + 1});
    }
  }
  return false;
}

bool CpuTraversal::leavesMeet(const Node& a, const Node& b, const Isometry3d& b_in_a, double margin) const
{
  for (std::uint32_t j = b.first; j < b.first + b.count; ++j)
  {
    const Triangle& t = triangles_[j];
    const Triangle triangle_b = {b_in_a * t[0], b_in_a * t[1], b_in_a * t[2]};
    for (std::uint32_t i = a.first; i < a.first + a.count; ++i)
    {
      if (margin > 0.0 ? trianglesWithin(triangles_[i], triangle_b, margin) : trianglesMeet(triangles_[i], triangle_b))
      {
        return true;
      }
    }
  }
  return false;
}
}  // namespace gpu_planning_scene
