#include "literature/trees/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

// G. Zachmann, "Minimal Hierarchical Collision Detection" (2002). A node is a side that it moves, one float, and a
// child. A split minimises the sum of the children's volumes. An empty side is cut off if it is at least 15 % of the
// box. (Own choice: each child gets at least a quarter of the triangles, because the sum of volumes alone would allow
// lists.) On the way down, each box is known in both frames. A cut changes three values in the other frame, and these
// are compared. So six axes are tested: those of both boxes. All of this is in float, without error bounds. Domain: any
// mesh, surfaces only.
namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr float kEmptyShare = 0.15F;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

float below(double value)
{
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) <= value ? rounded : std::nextafter(rounded, -kInfinity);
}

float above(double value)
{
  return -below(-value);
}

FloatBox boundsOf(const Triangle& t)
{
  FloatBox box;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto [lower, upper] = std::minmax({t[0][axis], t[1][axis], t[2][axis]});
    box.lower[axis] = below(lower);
    box.upper[axis] = above(upper);
  }
  return box;
}

void extend(FloatBox& box, const FloatBox& other)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    box.lower[axis] = std::min(box.lower[axis], other.lower[axis]);
    box.upper[axis] = std::max(box.upper[axis], other.upper[axis]);
  }
}

void cut(FloatBox& box, std::uint8_t side, float plane)
{
  (side % 2 == 0 ? box.lower : box.upper)[side / 2] = plane;
}

struct Cut
{
  std::uint8_t side;
  float plane;
};

/// The largest empty side, if it is large enough. `tight`: the bounds of the triangles in `box`.
std::optional<Cut> emptySide(const FloatBox& box, const FloatBox& tight)
{
  std::optional<Cut> best;
  float most = kEmptyShare;
  for (std::uint8_t side = 0; side < 6; ++side)
  {
    const int axis = side / 2;
    const float length = box.upper[axis] - box.lower[axis];
    const float gap = side % 2 == 0 ? tight.lower[axis] - box.lower[axis] : box.upper[axis] - tight.upper[axis];
    if (length > 0.0F && gap / length >= most)
    {
      most = gap / length;
      best = Cut{side, side % 2 == 0 ? tight.lower[axis] : tight.upper[axis]};
    }
  }
  return best;
}

struct Split
{
  int axis = 0;
  std::ptrdiff_t count = 0;  ///< triangles of the first child
  float first_upper = 0.0F;  ///< upper side of the first child
  float second_lower = 0.0F;
  float cost = kInfinity;  ///< sum of the children's volumes, divided by that of the parent
};

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
    result.lower[i] = below(lower);
    result.upper[i] = above(upper);
  }
  return result;
}

class Boxes : public Method
{
 public:
  Boxes(const Mesh& a, const Mesh& b) : a_(a), b_(b) {}

  std::vector<std::uint8_t> collide(const std::vector<Eigen::Isometry3d>& b_in_a) override
  {
    std::vector<std::uint8_t> answers;
    for (const Eigen::Isometry3d& pose : b_in_a)
    {
      pose_ = pose;
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
        {
          b_to_a_[i][k] = static_cast<float>(pose.linear()(i, k));
          a_to_b_[k][i] = static_cast<float>(pose.linear()(i, k));
        }
      const PairOfBoxes roots = {a_.rootBox(), b_.rootBox(), rotated(a_.rootBox(), pose.inverse()),
                                 rotated(b_.rootBox(), pose)};
      bool apart = false;
      for (int axis = 0; axis < 3; ++axis)
        apart = apart || apartAlong(axis, roots.a, roots.b_in_a) || apartAlong(axis, roots.b, roots.a_in_b);
      ++volume_tests_;
      answers.push_back(!apart && collides(a_.nodes().front(), b_.nodes().front(), roots) ? 1 : 0);
    }
    return answers;
  }

  WorkCounts work() const override { return {{"volume tests", volume_tests_}, {"triangle tests", triangle_tests_}}; }

 private:
  /// For two nodes whose boxes overlap.
  bool collides(const BoxTree::Node& a, const BoxTree::Node& b, const PairOfBoxes& boxes)
  {
    if (a.children == 0 && b.children == 0)
    {
      ++triangle_tests_;
      return trianglesOverlap(a_.triangles()[a.child],
                              moved(b_.triangles()[b.child], pose_.linear(), pose_.translation()));
    }
    if (a.children == 0)
      return openB(a, b, boxes);
    for (std::uint32_t i = 0; i < a.children; ++i)
    {
      const BoxTree::Node& child = a_.nodes()[a.child + i];
      PairOfBoxes smaller = boxes;
      ++volume_tests_;
      if (cutAndCompare(child, a_to_b_, smaller.a, smaller.a_in_b, smaller.b, smaller.b_in_a))
        continue;
      if (b.children == 0 ? collides(child, b, smaller) : openB(child, b, smaller))
        return true;
    }
    return false;
  }

  bool openB(const BoxTree::Node& a, const BoxTree::Node& b, const PairOfBoxes& boxes)
  {
    for (std::uint32_t i = 0; i < b.children; ++i)
    {
      const BoxTree::Node& child = b_.nodes()[b.child + i];
      PairOfBoxes smaller = boxes;
      ++volume_tests_;
      if (!cutAndCompare(child, b_to_a_, smaller.b, smaller.b_in_a, smaller.a, smaller.a_in_b) &&
          collides(a, child, smaller))
        return true;
    }
    return false;
  }

  BoxTree a_;
  BoxTree b_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  Rotation b_to_a_{};
  Rotation a_to_b_{};
  double volume_tests_ = 0.0;
  double triangle_tests_ = 0.0;
};

/// Improves `best` by splits along one axis. Sorts the triangles along it.
void trySplits(int axis, const FloatBox& box, const std::vector<FloatBox>& bounds, std::uint32_t* begin,
               std::uint32_t* end, Split& best)
{
  const float length = box.upper[axis] - box.lower[axis];
  if (!(length > 0.0F))
    return;
  const auto sum = [&](std::uint32_t t) { return bounds[t].lower[axis] + bounds[t].upper[axis]; };
  std::sort(begin, end,
            [&](std::uint32_t s, std::uint32_t t) { return sum(s) < sum(t) || (sum(s) == sum(t) && s < t); });
  const std::ptrdiff_t count = end - begin;
  std::vector<float> lower_from(count);  // of all triangles from here on
  float lower = kInfinity;
  for (std::ptrdiff_t i = count; i-- > 0;)
    lower_from[i] = lower = std::min(lower, bounds[begin[i]].lower[axis]);
  float upper = -kInfinity;
  for (std::ptrdiff_t i = 1; i <= count - std::max<std::ptrdiff_t>(1, count / 4); ++i)
  {
    upper = std::max(upper, bounds[begin[i - 1]].upper[axis]);
    const float cost = (upper - box.lower[axis] + box.upper[axis] - lower_from[i]) / length;
    if (i >= count / 4 && cost < best.cost)
      best = {axis, i, upper, lower_from[i], cost};
  }
}
}  // namespace

BoxTree::BoxTree(const Mesh& mesh) : triangles_(trianglesOf(mesh))
{
  std::vector<std::uint32_t> order(triangles_.size());
  std::iota(order.begin(), order.end(), 0U);
  for (const Triangle& t : triangles_)
    bounds_.push_back(boundsOf(t));
  root_box_ = bounds_.front();
  for (const FloatBox& box : bounds_)
    extend(root_box_, box);
  nodes_.emplace_back();
  build(0, root_box_, order.data(), order.data() + order.size());
  bounds_ = {};
}

void BoxTree::build(std::uint32_t node, FloatBox box, std::uint32_t* begin, std::uint32_t* end)
{
  FloatBox tight = bounds_[*begin];
  for (const std::uint32_t* i = begin; i != end; ++i)
    extend(tight, bounds_[*i]);
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  if (const std::optional<Cut> empty = emptySide(box, tight))
  {
    nodes_[node].child = child;
    nodes_[node].children = 1;
    nodes_.emplace_back();
    addChild(child, empty->side, empty->plane, box, begin, end);
    return;
  }
  if (end - begin == 1)
  {
    nodes_[node].child = *begin;
    return;
  }
  // If all triangles lie in one point, both children have the box of the parent.
  Split best{0, (end - begin) / 2, box.upper[0], box.lower[0], kInfinity};
  for (int axis = 0; axis < 3; ++axis)
    trySplits(axis, box, bounds_, begin, end, best);
  if (best.axis != 2 && best.cost < kInfinity)  // the triangles are sorted along z
  {
    Split again;
    trySplits(best.axis, box, bounds_, begin, end, again);
  }
  nodes_[node].child = child;
  nodes_[node].children = 2;
  nodes_.resize(nodes_.size() + 2);
  addChild(child, static_cast<std::uint8_t>(2 * best.axis + 1), best.first_upper, box, begin, begin + best.count);
  addChild(child + 1, static_cast<std::uint8_t>(2 * best.axis), best.second_lower, box, begin + best.count, end);
}

void BoxTree::addChild(std::uint32_t child, std::uint8_t side, float plane, FloatBox box, std::uint32_t* begin,
                       std::uint32_t* end)
{
  nodes_[child].side = side;
  nodes_[child].plane = plane;
  cut(box, side, plane);
  build(child, box, begin, end);
}

std::unique_ptr<Method> makeBoxTree(const Mesh& a, const Mesh& b)
{
  return std::make_unique<Boxes>(a, b);
}
}  // namespace gpu_planning_scene::core::literature
