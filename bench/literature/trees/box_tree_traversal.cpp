#include <algorithm>

#include "literature/trees/box_tree.h"
#include "literature/trees/tree_method.h"

// The traversal of G. Zachmann, "Minimal Hierarchical Collision Detection" (2002). On the way down, each box is known
// in both frames. A cut changes three values in the other frame, and these are compared. So six axes are tested: those
// of both boxes. All of this is in float, without error bounds. Domain: any mesh, surfaces only.
namespace gpu_planning_scene::core::literature
{
namespace
{
/// The box of node b in the frame of a, and the reverse, on the way down through both trees.
struct PairOfBoxes
{
  FloatBox a;
  FloatBox b;
  FloatBox a_in_b;
  FloatBox b_in_a;
};

bool apartAlong(int axis, const FloatBox& box, const FloatBox& other)
{
  return other.lower[axis] > box.upper[axis] || other.upper[axis] < box.lower[axis];
}

using BoxTreePtr = std::shared_ptr<const BoxTree>;
using Rotation = std::array<std::array<float, 3>, 3>;  // [axis of the other frame][axis of the own frame]

/// Moves a side of `own`, updates `own_in_other`, and returns whether the boxes are apart.
bool cutAndCompare(const BoxTree::Node& node, const Rotation& to_other, FloatBox& own, FloatBox& own_in_other,
                   const FloatBox& other, const FloatBox& other_in_own)
{
  const int axis = node.side / 2;
  const bool upper = node.side % 2 == 1;
  const float change = node.plane - (upper ? own.upper : own.lower)[axis];
  cut(own, node.side, node.plane);
  if (apartAlong(axis, own, other_in_own))
    return true;
  bool apart = false;
  for (int i = 0; i < 3; ++i)
  {
    const float component = to_other[i][axis];
    const bool moves_upper = (component > 0.0F) == upper;
    (moves_upper ? own_in_other.upper : own_in_other.lower)[i] += component * change;
    apart = apart || apartAlong(i, other, own_in_other);
  }
  return apart;
}

FloatBox rotated(const FloatBox& box, const Eigen::Isometry3d& pose)
{
  FloatBox result;
  for (int i = 0; i < 3; ++i)
  {
    double lower = pose.translation()[i];
    double upper = lower;
    for (int k = 0; k < 3; ++k)
    {
      const auto [least, most] = std::minmax({pose.linear()(i, k) * static_cast<double>(box.lower[k]),
                                              pose.linear()(i, k) * static_cast<double>(box.upper[k])});
      lower += least;
      upper += most;
    }
    result.lower[i] = floatBelow(lower);
    result.upper[i] = floatAbove(upper);
  }
  return result;
}

class Boxes : public TreeMethod
{
 public:
  Boxes(BoxTreePtr a, BoxTreePtr b)
    : TreeMethod(a->triangles(), b->triangles(), Search::First), a_(std::move(a)), b_(std::move(b))
  {
  }

 private:
  bool traverse() override
  {
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
      {
        b_to_a_[i][k] = static_cast<float>(pose().linear()(i, k));
        a_to_b_[k][i] = static_cast<float>(pose().linear()(i, k));
      }
    const PairOfBoxes roots = {a_->rootBox(), b_->rootBox(), rotated(a_->rootBox(), pose().inverse()),
                               rotated(b_->rootBox(), pose())};
    bool apart = false;
    for (int axis = 0; axis < 3; ++axis)
      apart = apart || apartAlong(axis, roots.a, roots.b_in_a) || apartAlong(axis, roots.b, roots.a_in_b);
    countVolumeTest();
    return !apart && traverse(a_->nodes().front(), b_->nodes().front(), roots);
  }

  /// For two nodes whose boxes overlap.
  bool traverse(const BoxTree::Node& a, const BoxTree::Node& b, const PairOfBoxes& boxes)
  {
    if (a.children == 0 && b.children == 0)
      return testLeaves(a.child, b.child);
    if (a.children == 0)
      return openB(a, b, boxes);
    for (std::uint32_t i = 0; i < a.children; ++i)
    {
      const BoxTree::Node& child = a_->nodes()[a.child + i];
      PairOfBoxes smaller = boxes;
      countVolumeTest();
      if (cutAndCompare(child, a_to_b_, smaller.a, smaller.a_in_b, smaller.b, smaller.b_in_a))
        continue;
      if (b.children == 0 ? traverse(child, b, smaller) : openB(child, b, smaller))
        return true;
    }
    return false;
  }

  bool openB(const BoxTree::Node& a, const BoxTree::Node& b, const PairOfBoxes& boxes)
  {
    for (std::uint32_t i = 0; i < b.children; ++i)
    {
      const BoxTree::Node& child = b_->nodes()[b.child + i];
      PairOfBoxes smaller = boxes;
      countVolumeTest();
      if (!cutAndCompare(child, b_to_a_, smaller.b, smaller.b_in_a, smaller.a, smaller.a_in_b) &&
          traverse(a, child, smaller))
        return true;
    }
    return false;
  }

  BoxTreePtr a_;
  BoxTreePtr b_;
  Rotation b_to_a_{};
  Rotation a_to_b_{};
};
}  // namespace

std::unique_ptr<Method> makeBoxTree(const MeshPtr& a, const MeshPtr& b)
{
  return std::make_unique<Boxes>(sharedTree<BoxTree>(a), sharedTree<BoxTree>(b));
}
}  // namespace gpu_planning_scene::core::literature
