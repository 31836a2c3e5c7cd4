#include "collision/exact/cpu_shape_pair.h"

#include "collision/exact/winding_number.h"
#include "collision/geometry/cpu_box_pair.h"
#include "collision/geometry/primitive_solid.h"

// Meshes are decided by a simultaneous traversal of two trees of oriented boxes (Gottschalk, Lin and Manocha,
// "OBBTree", 1996), with exact tests at the leaves. If the surfaces do not meet, winding numbers tell whether one shape
// is inside the other.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Boxes are grown by this margin, so that a pair is lost neither to rounding in the box tests nor to kSlack.
constexpr double kBoxMargin = 1e-9;  // metres

// Nodes count as a collision only if they are within the tolerance by this margin, which exceeds their rounding error.
constexpr double kToleranceMargin = 1e-9;  // metres

// The test of two solids costs about as much as visiting this many nodes.
constexpr std::uint64_t kStepsOfSolids = 20;

bool leavesMeet(const CpuTree& tree_a, const CpuNode& a, const CpuTree& tree_b, const CpuNode& b,
                const Isometry3d& b_in_a, double required)
{
  for (std::uint32_t j = b.first; j < b.first + b.count; ++j)
  {
    const Triangle& t = tree_b.triangles[j];
    const Triangle triangle_b = {b_in_a * t[0], b_in_a * t[1], b_in_a * t[2]};
    for (std::uint32_t i = a.first; i < a.first + a.count; ++i)
      if (trianglesWithin(tree_a.triangles[i], triangle_b, required))
        return true;
  }
  return false;
}

/// Whether a component of one mesh lies inside the solid of the other. The surfaces must not meet. Then each point of a
/// component gives the same answer, so one point suffices.
bool containsComponent(const CpuTree& outer, const CpuTree& inner, const Isometry3d& inner_in_outer,
                       std::vector<std::uint32_t>& stack)
{
  const AlignedBox3d& bounds = outer.solid_bounds;
  if (bounds.isEmpty())
    return false;
  const double diagonal = bounds.diagonal().norm() + kBoxMargin;
  for (const Component& component : inner.components.components)
  {
    // Each side of the component's box is the distance of two of its points along an axis. If a side exceeds the
    // diagonal of the solid's bounds, the component does not fit into the solid.
    const Vector3d point = inner_in_outer * component.point;
    if (bounds.contains(point) && component.bounds.sizes().maxCoeff() <= diagonal && isInsideSolid(outer, point, stack))
      return true;
  }
  return false;
}
}  // namespace

AlignedBox3d boundsOf(const CpuTree& tree, const Isometry3d& pose)
{
  const Vector3d center = pose * tree.center;
  const Vector3d half = (pose.linear().cwiseAbs() * tree.half).array() + kBoxMargin;
  return {center - half, center + half};
}

bool CpuShapePair::collide(std::uint32_t a, const Isometry3d& pose_a, std::uint32_t b, const Isometry3d& pose_b,
                           double required, Scratch& scratch) const
{
  const CpuTree& tree_a = forest_->tree(a);
  const CpuTree& tree_b = forest_->tree(b);
  const Isometry3d b_in_a = relativePose(pose_a, pose_b);
  if (!overlap(tree_a.box, placed(tree_b.box, b_in_a), required + kBoxMargin))
    return false;
  if (tree_a.mesh && tree_b.mesh)
  {
    return surfacesMeet(tree_a, tree_b, b_in_a, required, scratch) ||
           containsComponent(tree_a, tree_b, b_in_a, scratch.nodes) ||
           containsComponent(tree_b, tree_a, b_in_a.inverse(), scratch.nodes);
  }
  if (!tree_a.mesh && !tree_b.mesh)
  {
    scratch.steps += kStepsOfSolids;
    return solidsWithin(tree_a.shape, tree_b.shape, b_in_a, required);
  }
  // surfaceMeetsSolid also finds triangles inside the primitive. The remaining case is a primitive inside the mesh.
  const Isometry3d a_in_b = b_in_a.inverse();
  return tree_a.mesh ? surfaceMeetsSolid(tree_a, tree_b, a_in_b, required, scratch) ||
                           isInsideSolid(tree_a, b_in_a.translation(), scratch.nodes)
                     : surfaceMeetsSolid(tree_b, tree_a, b_in_a, required, scratch) ||
                           isInsideSolid(tree_b, a_in_b.translation(), scratch.nodes);
}

bool CpuShapePair::surfaceMeetsSolid(const CpuTree& mesh, const CpuTree& solid, const Isometry3d& mesh_in_solid,
                                     double required, Scratch& scratch) const
{
  const Shape& shape = solid.shape;
  const bool box = std::holds_alternative<Box>(shape);
  const double margin = required + kBoxMargin;
  const Vector3d grown = solid.half.array() + margin;
  const double near_enough = required + tolerance_ - kToleranceMargin;

  scratch.nodes.assign(1, 0);
  while (!scratch.nodes.empty())
  {
    const CpuNode& node = mesh.nodes[scratch.nodes.back()];
    scratch.nodes.pop_back();
    ++scratch.steps;
    const OrientedBox around = placed(node.box, mesh_in_solid);
    if (!BoxPairTest(around.axes).overlap(grown, around.half, around.center))
      continue;
    if (!box || required > 0.0 || tolerance_ > 0.0)
    {
      const double distance = distanceToSolid(shape, around.center);
      const double radius = around.half.norm();
      if (distance > radius + margin)
        continue;
      // All triangles of a node are within `radius` of the node's centre, and each node has a triangle.
      if (tolerance_ > 0.0 && distance + radius <= near_enough)
        return true;
    }
    if (!node.isLeaf())
    {
      scratch.nodes.push_back(node.first);
      scratch.nodes.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    {
      const Triangle& t = mesh.triangles[i];
      if (triangleWithinSolid({mesh_in_solid * t[0], mesh_in_solid * t[1], mesh_in_solid * t[2]}, shape, required))
        return true;
    }
  }
  return false;
}

/// Simultaneous traversal of two trees. The boxes of each pair of nodes overlap; the caller has tested the root boxes.
/// The larger node of a pair is opened.
///
/// With a tolerance, the traversal stops at two nodes that are close enough to count as a collision. Each node has a
/// triangle, and all points of this triangle are within the node's radius (half the diagonal of its box) of the box's
/// centre. So the distance of the two triangles is at most the distance of the centres plus both radii. The traversal
/// stops if this sum is at most the required distance plus the tolerance.
///
/// Example: the required distance is 0, two nodes overlap, and their diagonals add up to at most the tolerance. Then
/// the radii add up to at most half of the tolerance, and so does the distance of the centres. For a required distance
/// v > 0, the overlap of boxes grown by v would prove less, because their corners reach v times the square root of 3.
bool CpuShapePair::surfacesMeet(const CpuTree& a, const CpuTree& b, const Isometry3d& b_in_a, double required,
                                Scratch& scratch) const
{
  const Isometry3d a_in_b = b_in_a.inverse();
  const double growth = required + kBoxMargin;
  const double near_enough = required + tolerance_ - kToleranceMargin;
  scratch.node_pairs.assign(1, {0, 0});
  while (!scratch.node_pairs.empty())
  {
    const auto [index_a, index_b] = scratch.node_pairs.back();
    scratch.node_pairs.pop_back();
    const CpuNode& node_a = a.nodes[index_a];
    const CpuNode& node_b = b.nodes[index_b];
    if (node_a.isLeaf() && node_b.isLeaf())
    {
      if (leavesMeet(a, node_a, b, node_b, b_in_a, required))
        return true;
      continue;
    }
    const bool open_a = opensFirst(node_a, node_b);
    const OrientedBox other = open_a ? placed(node_b.box, b_in_a) : placed(node_a.box, a_in_b);
    const std::uint32_t first = open_a ? node_a.first : node_b.first;
    for (const std::uint32_t child : {first, first + 1})
    {
      const OrientedBox& box = (open_a ? a : b).nodes[child].box;
      ++scratch.steps;
      if (!overlap(box, other, growth))
        continue;
      if (tolerance_ > 0.0 && (box.center - other.center).norm() + box.half.norm() + other.half.norm() <= near_enough)
        return true;
      scratch.node_pairs.push_back({open_a ? child : index_a, open_a ? index_b : child});
    }
  }
  return false;
}

bool CpuShapePair::collide(std::uint32_t number, const Isometry3d& pose, const PlacedHalfSpace& half_space,
                           double required, Scratch& scratch) const
{
  const CpuTree& tree = forest_->tree(number);
  const Vector3d normal = pose.linear().transpose() * half_space.normal;  // normal in the shape's frame
  const double most = half_space.offset - half_space.normal.dot(pose.translation()) + required + kSlack;
  if (!tree.mesh)
    return -reachAlong(tree.shape, -normal) <= most;
  scratch.nodes.assign(1, 0);
  while (!scratch.nodes.empty())
  {
    const CpuNode& node = tree.nodes[scratch.nodes.back()];
    scratch.nodes.pop_back();
    ++scratch.steps;
    const double reach = (node.box.axes.transpose() * normal).cwiseAbs().dot(node.box.half);
    if (normal.dot(node.box.center) - reach > most + kBoxMargin)
      continue;
    if (!node.isLeaf())
    {
      scratch.nodes.push_back(node.first);
      scratch.nodes.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    {
      for (const Vector3d& vertex : tree.triangles[i])
        if (normal.dot(vertex) <= most)
          return true;
    }
  }
  return false;
}
}  // namespace gpu_planning_scene::core
