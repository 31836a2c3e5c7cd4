#include "collision/exact/cpu_shape_pair.h"

#include <algorithm>
#include <array>
#include <utility>

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

// Boxes are grown by this margin. It exceeds the rounding of the box tests plus kSlack, so no colliding pair is lost.
constexpr double kBoxMargin = 1e-9;  // metres

// Nodes count as a collision only if they are within the required distance by this margin, which exceeds their rounding
// error.
constexpr double kProofMargin = 1e-9;  // metres

// The test of two solids costs about as much as visiting this many nodes, and so does a search for an axis that
// separates a triangle from a solid.
constexpr std::uint64_t kStepsOfSolids = 20;
constexpr std::uint64_t kStepsOfSearch = 200;
// Boxes whose radius is below this multiple of the float errors are also tested in double: in a mesh with a large
// reach, the errors exceed the size of many boxes, and the float test would separate hardly any of these boxes.
constexpr double kSmallBox = 64.0;

bool leafMeetsSolid(const CpuTree& mesh, BoxIndex leaf, const Shape& shape, const Isometry3d& mesh_in_solid,
                    double required, CpuShapePair::Scratch& scratch)
{
  const std::uint64_t searches = scratch.axis.searches;
  const CpuNode& node = mesh.nodes[mesh.wide.source(leaf)];
  const auto first = mesh.triangles.begin() + node.first;
  const bool meets =
      std::any_of(first, first + node.count,
                  [&](const Triangle& t)
                  {
                    return triangleWithinSolid({mesh_in_solid * t[0], mesh_in_solid * t[1], mesh_in_solid * t[2]},
                                               shape, required, &scratch.axis);
                  });
  scratch.steps += kStepsOfSearch * (scratch.axis.searches - searches);
  return meets;
}

/// Whether boxes in one frame are farther apart than `distance`. A distance of 0 is tested with kBoxMargin.
bool areApart(const OrientedBox& a, const OrientedBox& b, double distance)
{
  return !overlap(a, b, distance) || (distance > kBoxMargin && apartAlongCenters(a, b, distance));
}

/// Whether the plane across the vector from the nearest point of the solid to the centre of the box is farther than
/// `distance` from the solid, with the box beyond. `from_solid`: this vector, not 0.
bool isBeyondSolid(const OrientedBox& box, const Shape& shape, const Isometry3d& box_in_solid,
                   const Vector3d& from_solid, double distance)
{
  const Vector3d normal = from_solid.normalized();
  const Vector3d along_axes = box.axes.transpose() * (box_in_solid.linear().transpose() * normal);
  const double least = normal.dot(box_in_solid * box.center) - along_axes.cwiseAbs().dot(box.half);
  return least - reachAlong(shape, normal) > distance;
}

/// Whether a component of one mesh lies inside the solid of the other. The surfaces must not meet. Then all points of a
/// component give the same answer, so one point suffices.
bool containsComponent(const CpuTree& outer, const CpuTree& inner, const Isometry3d& inner_in_outer,
                       std::vector<std::uint32_t>& stack)
{
  const AlignedBox3d& bounds = outer.solid_bounds;
  if (bounds.isEmpty())
    return false;
  const double diagonal = bounds.diagonal().norm() + kBoxMargin;
  for (const Component& component : componentsOf(inner))
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
  const Vector3d center = transformed(tree.center, pose);
  const Vector3d half = (pose.linear().cwiseAbs() * tree.half).array() + kBoxMargin;
  return {center - half, center + half};
}

bool CpuShapePair::collide(std::uint32_t a, const Isometry3d& pose_a, std::uint32_t b, const Isometry3d& pose_b,
                           double required, Scratch& scratch) const
{
  return collide(forest_->tree(a), pose_a, forest_->tree(b), pose_b, required, scratch);
}

bool CpuShapePair::collide(std::uint32_t tree, const Isometry3d& pose, const PlacedHalfSpace& half_space,
                           double required, Scratch& scratch) const
{
  return collide(forest_->tree(tree), pose, half_space, required, scratch);
}

bool CpuShapePair::collide(const CpuTree& tree_a, const Isometry3d& pose_a, const CpuTree& tree_b,
                           const Isometry3d& pose_b, double required, Scratch& scratch) const
{
  const Isometry3d b_in_a = relativePose(pose_a, pose_b);
  if (areApart(tree_a.box, placed(tree_b.box, b_in_a), required + kBoxMargin))
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
  // For a box without a required distance, the overlap test is enough, because the solid fills its bounding box. In all
  // other cases, the distance from the solid separates more nodes.
  const bool by_distance = !std::holds_alternative<Box>(shape) || required > 0.0;
  const double margin = required + kBoxMargin;
  const double near_enough = required - kProofMargin;
  const WideTree& tree = mesh.wide;
  const OrientedBox around = placed(solid.box, mesh_in_solid.inverse());
  const FloatBox around_in_floats = floatBox(around, tree, margin);
  const double small =
      kSmallBox * floatErrors((around.center - tree.origin()).norm(), around.half.norm() + tree.reach(), margin);

  scratch.axis.direction.setZero();
  scratch.nodes.assign(1, WideTree::kRoot);
  while (!scratch.nodes.empty())
  {
    const BoxIndex box = scratch.nodes.back();
    scratch.nodes.pop_back();
    if (tree.isLeaf(box))
    {
      if (leafMeetsSolid(mesh, box, shape, mesh_in_solid, required, scratch))
        return true;
      continue;
    }
    scratch.steps += Scratch::kStepsOfEightBoxes;
    for (unsigned hits = tests_.overlap(tree.below(box), around_in_floats); hits != 0; hits &= hits - 1)
    {
      const BoxIndex child = tree.child(box, lowestBit(hits));
      const OrientedBox& child_box = mesh.nodes[tree.source(child)].box;
      if (tree.radius(child) < small && areApart(child_box, around, margin))
        continue;
      if (by_distance)
      {
        const Vector3d from_solid = vectorFromSolid(shape, mesh_in_solid * tree.center(child));
        const double distance = from_solid.norm();
        const double radius = tree.radius(child) + tree.centerError();
        if (distance > radius + margin)
          continue;
        // All triangles of a node are within `radius` of the node's centre, and each node has a triangle.
        if (distance + radius <= near_enough)
          return true;
        // Of a box that is small against the distance, the extent along the axis separates more than the radius.
        if (margin > radius && distance > margin && isBeyondSolid(child_box, shape, mesh_in_solid, from_solid, margin))
          continue;
      }
      scratch.nodes.push_back(child);
    }
  }
  return false;
}

/// Only the pairs of triangles that floats cannot separate are tested in double.
bool CpuShapePair::leavesMeet(const CpuTree& a, BoxIndex leaf_a, const CpuTree& b, BoxIndex leaf_b,
                              const Isometry3d& b_in_a, const WidePlacement& in_a, double required) const
{
  const TriangleBlock& block_a = a.wide.triangles(leaf_a);
  const TriangleBlock& block_b = b.wide.triangles(leaf_b);
  for (unsigned near = tests_.near_triangles(block_a, in_a.place(block_b), in_a.distance()); near != 0;
       near &= near - 1)
  {
    const unsigned bit = lowestBit(near);
    const Triangle& t = b.triangles[block_b.first + bit / kBlockTriangles];
    if (trianglesWithin(a.triangles[block_a.first + bit % kBlockTriangles],
                        {b_in_a * t[0], b_in_a * t[1], b_in_a * t[2]}, required))
      return true;
  }
  return false;
}

/// Simultaneous traversal of two trees. The boxes of each pair overlap; the caller has tested the root boxes. The
/// larger box of a pair is opened: the boxes below it are tested together.
///
/// With a required distance, the traversal stops at two nodes that are close enough to collide. Each node has a
/// triangle, and all points of this triangle are within the node's radius (half the diagonal of its box) of the box's
/// centre. So the distance of the two triangles is at most the distance of the centres plus both radii. The traversal
/// stops if this sum is at most the required distance. It opens the pair with the nearest centres first, because this
/// pair most likely collides. The overlap of boxes grown by the required distance v would prove less, because their
/// corners reach v times the square root of 3.
bool CpuShapePair::surfacesMeet(const CpuTree& a, const CpuTree& b, const Isometry3d& b_in_a, double required,
                                Scratch& scratch) const
{
  const double near_enough = required - kProofMargin - a.wide.centerError() - b.wide.centerError();
  const double growth = required + kBoxMargin;
  const WidePlacement in_a(b.wide, b_in_a, a.wide, growth);
  const WidePlacement in_b(a.wide, b_in_a.inverse(), b.wide, growth);
  const double small = kSmallBox * in_a.errors();
  const bool by_distance = required > 0.0;
  std::array<double, kWideSlots> distances;  // of the centres of the pairs that the opened box adds
  scratch.node_pairs.assign(1, {WideTree::kRoot, WideTree::kRoot});
  while (!scratch.node_pairs.empty())
  {
    const auto [box_a, box_b] = scratch.node_pairs.back();
    scratch.node_pairs.pop_back();
    if (a.wide.isLeaf(box_a) && b.wide.isLeaf(box_b))
    {
      if (leavesMeet(a, box_a, b, box_b, b_in_a, in_a, required))
        return true;
      continue;
    }
    const bool open_a = opensFirst(a.wide, box_a, b.wide, box_b);
    const WideTree& opened = open_a ? a.wide : b.wide;
    const BoxIndex box = open_a ? box_a : box_b;
    const FloatBox other = open_a ? in_a.place(b.wide, box_b) : in_b.place(a.wide, box_a);
    scratch.steps += Scratch::kStepsOfEightBoxes;
    const std::size_t first = scratch.node_pairs.size();
    for (unsigned hits = tests_.overlap(opened.below(box), other); hits != 0; hits &= hits - 1)
    {
      const BoxIndex child = opened.child(box, lowestBit(hits));
      const std::array<BoxIndex, 2> pair = {open_a ? child : box_a, open_a ? box_b : child};
      if (opened.radius(child) < small &&
          areApart(a.nodes[a.wide.source(pair[0])].box, placed(b.nodes[b.wide.source(pair[1])].box, b_in_a), growth))
        continue;
      scratch.node_pairs.push_back(pair);
      if (!by_distance)
        continue;
      const double distance = (b_in_a * b.wide.center(pair[1]) - a.wide.center(pair[0])).norm();
      if (distance + a.wide.radius(pair[0]) + b.wide.radius(pair[1]) <= near_enough)
        return true;
      std::size_t place = scratch.node_pairs.size() - 1 - first;
      for (; place > 0 && distances[place - 1] < distance; --place)
      {
        distances[place] = distances[place - 1];
        std::swap(scratch.node_pairs[first + place], scratch.node_pairs[first + place - 1]);
      }
      distances[place] = distance;
    }
  }
  return false;
}

bool CpuShapePair::collide(const CpuTree& tree, const Isometry3d& pose, const PlacedHalfSpace& half_space,
                           double required, Scratch& scratch) const
{
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
