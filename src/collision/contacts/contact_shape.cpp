#include "collision/contacts/contact_shape.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "collision/exact/winding_number.h"
#include "collision/geometry/cpu_box_pair.h"
#include "collision/geometry/primitive_solid.h"

// The farthest vertex of a mesh along a direction comes from its tree: a node is left out if its box does not reach
// beyond the best vertex so far (branch and bound).
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

Vector3d farthestVertex(const CpuTree& tree, const Vector3d& direction, std::vector<std::uint32_t>& stack)
{
  Vector3d best = tree.triangles.front()[0];
  double reach = direction.dot(best);
  const auto reach_of = [&](std::uint32_t node)
  {
    const OrientedBox& box = tree.nodes[node].box;
    return direction.dot(box.center) + (box.axes.transpose() * direction).cwiseAbs().dot(box.half);
  };
  stack.assign(1, 0);
  while (!stack.empty())
  {
    const CpuNode& node = tree.nodes[stack.back()];
    stack.pop_back();
    if (!node.isLeaf())
    {
      const double first = reach_of(node.first);
      const double second = reach_of(node.first + 1);
      const std::uint32_t farther = first >= second ? node.first : node.first + 1;
      if (std::min(first, second) > reach)
        stack.push_back(2 * node.first + 1 - farther);
      if (std::max(first, second) > reach)
        stack.push_back(farther);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      for (const Vector3d& vertex : tree.triangles[i])
        if (direction.dot(vertex) > reach)
        {
          reach = direction.dot(vertex);
          best = vertex;
        }
  }
  return best;
}

bool isOnSurface(const CpuTree& tree, const Vector3d& point, std::vector<std::uint32_t>& stack)
{
  stack.assign(1, 0);
  while (!stack.empty())
  {
    const CpuNode& node = tree.nodes[stack.back()];
    stack.pop_back();
    const OrientedBox& box = node.box;
    if (((box.axes.transpose() * (point - box.center)).cwiseAbs().array() > box.half.array() + kOnShape).any())
      continue;
    if (!node.isLeaf())
    {
      stack.push_back(node.first);
      stack.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if ((nearestPoint(tree.triangles[i], point) - point).norm() <= kOnShape)
        return true;
  }
  return false;
}
}  // namespace

bool isConvexSolid(const CpuTree& tree)
{
  if (!tree.mesh)
    return true;
  if (componentsOf(tree).size() != 1 || !tree.solid->hasSolid() || !tree.solid->isAllSolid())
    return false;
  const double tolerance = 1e-9 * tree.half.norm();
  std::vector<std::uint32_t> stack;
  Vector3d middle = Vector3d::Zero();  // a point of the hull
  for (const Triangle& t : tree.triangles)
    middle += (t[0] + t[1] + t[2]) / (3.0 * static_cast<double>(tree.triangles.size()));
  // The winding number decides what is inside, so the faces may be turned outwards or inwards.
  return std::all_of(tree.triangles.begin(), tree.triangles.end(),
                     [&](const Triangle& t)
                     {
                       const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
                       if (normal.norm() <= 1e-9 * tolerance * tolerance)
                         return true;
                       const double sign = normal.dot(middle - t[0]) > 0.0 ? -1.0 : 1.0;
                       const Vector3d outward = sign * normal.normalized();
                       return outward.dot(farthestVertex(tree, outward, stack) - t[0]) <= tolerance;
                     });
}

Vector3d ShapeHull::farthest(const Vector3d& direction) const
{
  const Vector3d local = pose_.linear().transpose() * direction;
  if (tree_.mesh)
    return pose_ * farthestVertex(tree_, local, stack_);
  return pose_ * (std::holds_alternative<Sphere>(tree_.shape) ? Vector3d::Zero() : farthestOfSolid(tree_.shape, local));
}

PointHull::PointHull(std::vector<Vector3d> points) : points_(std::move(points)), center_(Vector3d::Zero()), radius_(0.0)
{
  for (const Vector3d& point : points_)
    center_ += point / static_cast<double>(points_.size());
  for (const Vector3d& point : points_)
    radius_ = std::max(radius_, (point - center_).norm());
}

Vector3d PointHull::farthest(const Vector3d& direction) const
{
  return *std::max_element(
      points_.begin(), points_.end(),
      [&](const Vector3d& a, const Vector3d& b) { return direction.dot(a) < direction.dot(b); });
}

double sphereRadius(const CpuTree& tree)
{
  const Sphere* sphere = std::get_if<Sphere>(&tree.shape);
  return sphere ? sphere->radius : 0.0;
}

ConvexSeparation hullSeparation(const ContactShape& a, const ContactShape& b)
{
  const Isometry3d b_in_a = relativePose(a.pose, b.pose);
  ConvexSeparation found = separationOf(ShapeHull(*a.tree, Isometry3d::Identity()), ShapeHull(*b.tree, b_in_a));
  const double radius_a = sphereRadius(*a.tree);
  const double radius_b = sphereRadius(*b.tree);
  found.on_a = a.pose * Vector3d(found.on_a + radius_a * found.normal);
  found.on_b = a.pose * Vector3d(found.on_b - radius_b * found.normal);
  found.depth += radius_a + radius_b;
  found.least_depth += radius_a + radius_b;
  found.normal = (a.pose.linear() * found.normal).normalized();
  return found;
}

bool hasExactSeparation(const ContactShape& a, const ContactShape& b)
{
  const auto is_curved = [](const ContactShape& shape)
  { return std::holds_alternative<Cylinder>(shape.tree->shape) || std::holds_alternative<Cone>(shape.tree->shape); };
  constexpr double kLargest = 100.0;  // metres; half of both diagonals
  return a.is_convex && b.is_convex && !(is_curved(a) && is_curved(b)) &&
         a.tree->half.norm() + b.tree->half.norm() <= kLargest;
}

double reachOf(const ContactShape& shape, const Vector3d& direction)
{
  return direction.dot(ShapeHull(*shape.tree, shape.pose).farthest(direction)) + sphereRadius(*shape.tree);
}

bool contains(const ContactShape& shape, const Vector3d& point)
{
  const Vector3d local = shape.pose.linear().transpose() * (point - shape.pose.translation());
  if (!shape.tree->mesh)
    return distanceToSolid(shape.tree->shape, local) <= kOnShape;
  std::vector<std::uint32_t> stack;
  return isOnSurface(*shape.tree, local, stack) || isInsideSolid(*shape.tree, local, stack);
}

double depthInside(const ContactShape& shape, const Vector3d& point)
{
  const CpuTree& tree = *shape.tree;
  const Vector3d local = shape.pose.linear().transpose() * (point - shape.pose.translation());
  if (!tree.mesh)
    return depthInSolid(tree.shape, local);
  double depth = std::numeric_limits<double>::infinity();
  std::vector<std::uint32_t> stack(1, 0);
  while (!stack.empty())
  {
    const CpuNode& node = tree.nodes[stack.back()];
    stack.pop_back();
    const Vector3d beyond = (node.box.axes.transpose() * (local - node.box.center)).cwiseAbs() - node.box.half;
    if (beyond.cwiseMax(0.0).norm() >= depth)
      continue;
    if (!node.isLeaf())
    {
      stack.push_back(node.first);
      stack.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      depth = std::min(depth, (nearestPoint(tree.triangles[i], local) - local).norm());
  }
  return depth > kOnShape && isInsideSolid(tree, local, stack) ? depth - kOnShape : 0.0;
}
}  // namespace gpu_planning_scene::core
