#include "collision/trees/wide_tree.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "collision/trees/cpu_tree.h"

// A wide node begins with the two children of a binary node. Its largest inner box is replaced by the two children of
// that box until the node has eight boxes (H. Dammertz, J. Hanika, A. Keller: Shallow bounding volume hierarchies for
// fast SIMD ray tracing of incoherent rays. Computer Graphics Forum, 2008).
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

// The rounding errors of both trees, of the placed box and of the overlap test are below this share of the lengths that
// floatErrors adds up: 64 times 2^-24. docs/error_bounds.md derives 30 times 2^-24.
constexpr double kFloatErrors = 64.0 * 0.5 * std::numeric_limits<float>::epsilon();

/// The least float that is not below `value`, or a little more.
float roundedUp(double value)
{
  return static_cast<float>(value * (1.0 + std::numeric_limits<float>::epsilon()));
}

/// The nodes of the binary tree whose boxes become the wide node below `top`. Begins with the two children of `top`.
/// Then replaces the largest inner node by its two children, as long as there is room.
std::vector<std::uint32_t> boxesOf(const std::vector<CpuNode>& nodes, std::uint32_t top)
{
  std::vector<std::uint32_t> boxes = {nodes[top].first, nodes[top].first + 1};
  const auto size = [&nodes](std::uint32_t i) { return nodes[i].isLeaf() ? -1.0 : nodes[i].box.half.squaredNorm(); };
  while (boxes.size() < kWideSlots)
  {
    const auto largest = std::max_element(boxes.begin(), boxes.end(),
                                          [&size](std::uint32_t i, std::uint32_t j) { return size(i) < size(j); });
    if (nodes[*largest].isLeaf())
      break;
    const std::uint32_t first = nodes[*largest].first;
    *largest = first;
    boxes.push_back(first + 1);
  }
  return boxes;
}

void setBox(const OrientedBox& box, const Vector3d& origin, unsigned slot, WideNode& node)
{
  const Vector3d center = box.center - origin;
  for (int k = 0; k < 3; ++k)
  {
    for (int i = 0; i < 3; ++i)
      node.axes[i][k][slot] = static_cast<float>(box.axes(k, i));
    node.center[k][slot] = static_cast<float>(center[k]);
    node.half[k][slot] = roundedUp(box.half[k]);
  }
  node.radius[slot] = roundedUp(box.half.norm());
}

TriangleBlock blockOf(const CpuNode& leaf, const std::vector<Triangle>& triangles, const Vector3d& origin)
{
  static_assert(kLeafTriangles <= kBlockTriangles, "one block for each leaf");
  if (leaf.count < 1 || leaf.count > kBlockTriangles)
    throw std::logic_error("a leaf of a tree has " + std::to_string(leaf.count) + " triangles, not 1 to " +
                           std::to_string(kBlockTriangles));
  TriangleBlock block;
  block.first = leaf.first;
  block.count = leaf.count;
  for (unsigned slot = 0; slot < kBlockTriangles; ++slot)
  {
    const Triangle& triangle = triangles[leaf.first + std::min(slot, leaf.count - 1)];
    for (int corner = 0; corner < 3; ++corner)
      for (int k = 0; k < 3; ++k)
        block.corners[corner][k][slot] = static_cast<float>(triangle[corner][k] - origin[k]);
  }
  return block;
}
}  // namespace

WideTree::WideTree(const std::vector<CpuNode>& nodes, const std::vector<Triangle>& triangles, const Vector3d& origin)
  : origin_(origin)
{
  for (const CpuNode& node : nodes)
    reach_ = std::max(reach_, (node.box.center - origin).norm() + node.box.half.norm());

  struct Open
  {
    std::uint32_t node;  // of the binary tree
    BoxIndex box;
  };
  std::vector<Open> open;
  const auto add = [&](const std::vector<std::uint32_t>& boxes)
  {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    WideNode& node = nodes_.emplace_back();
    for (const std::uint32_t from : boxes)
    {
      setBox(nodes[from].box, origin_, node.boxes, node);
      node.source[node.boxes] = from;
      if (nodes[from].isLeaf())
      {
        node.block[node.boxes] = static_cast<std::uint32_t>(blocks_.size());
        blocks_.push_back(blockOf(nodes[from], triangles, origin_));
      }
      else
        open.push_back({from, kWideSlots * index + node.boxes});
      ++node.boxes;
    }
    return index;
  };
  add({0});
  while (!open.empty())
  {
    const Open top = open.back();
    open.pop_back();
    const std::uint32_t below = add(boxesOf(nodes, top.node));
    nodes_[top.box / kWideSlots].below[slot(top.box)] = below;
  }
}

Vector3d WideTree::center(BoxIndex box) const
{
  const WideNode& from = node(box);
  const unsigned i = slot(box);
  return origin_ + Vector3d(from.center[0][i], from.center[1][i], from.center[2][i]);
}

WidePlacement::WidePlacement(const WideTree& from, const Isometry3d& from_in_to, const WideTree& to, double required)
{
  const Vector3d translation = from_in_to * from.origin() - to.origin();
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
      rotation_[row][column] = static_cast<float>(from_in_to.linear()(row, column));
    translation_[row] = static_cast<float>(translation[row]);
  }
  errors_ = floatErrors(translation.norm(), from.reach() + to.reach(), required);
  distance_ = roundedUp(required + errors_);
  has_long_distance_ = required > errors_;
}

FloatBox WidePlacement::place(const WideTree& from, BoxIndex box) const
{
  const WideNode& node = from.node(box);
  const unsigned slot = WideTree::slot(box);
  FloatBox placed;
  const float x = node.center[0][slot];
  const float y = node.center[1][slot];
  const float z = node.center[2][slot];
  for (int row = 0; row < 3; ++row)
  {
    const float* r = rotation_[row];
    for (int axis = 0; axis < 3; ++axis)
      placed.axes[axis][row] =
          r[0] * node.axes[axis][0][slot] + r[1] * node.axes[axis][1][slot] + r[2] * node.axes[axis][2][slot];
    placed.center[row] = r[0] * x + r[1] * y + r[2] * z + translation_[row];
    placed.half[row] = node.half[row][slot] + distance_;
  }
  placed.distance = distance_;
  placed.has_long_distance = has_long_distance_;
  return placed;
}

TriangleBlock WidePlacement::place(const TriangleBlock& block) const
{
  TriangleBlock placed;
  placed.first = block.first;
  placed.count = block.count;
  for (int corner = 0; corner < 3; ++corner)
  {
    const auto& from = block.corners[corner];
    for (int row = 0; row < 3; ++row)
    {
      const float* r = rotation_[row];
      for (unsigned i = 0; i < kBlockTriangles; ++i)
        placed.corners[corner][row][i] = r[0] * from[0][i] + r[1] * from[1][i] + r[2] * from[2][i] + translation_[row];
    }
  }
  return placed;
}

FloatBox floatBox(const OrientedBox& box, const WideTree& tree, double required)
{
  const Vector3d center = box.center - tree.origin();
  const double errors = floatErrors(center.norm(), box.half.norm() + tree.reach(), required);
  FloatBox converted;
  converted.distance = roundedUp(required + errors);
  converted.has_long_distance = required > errors;
  for (int k = 0; k < 3; ++k)
  {
    for (int axis = 0; axis < 3; ++axis)
      converted.axes[axis][k] = static_cast<float>(box.axes(k, axis));
    converted.center[k] = static_cast<float>(center[k]);
    converted.half[k] = roundedUp(box.half[k]) + converted.distance;
  }
  return converted;
}

double floatErrors(double distance, double reaches, double required)
{
  return kFloatErrors * (2.0 * distance + 3.0 * reaches + required);
}
}  // namespace gpu_planning_scene::core
