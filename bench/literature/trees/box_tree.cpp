#include "literature/trees/box_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

// The construction of G. Zachmann, "Minimal Hierarchical Collision Detection" (2002). A node is a side that it moves,
// one float, and a child. A split minimises the sum of the children's volumes. An empty side is cut off if it is at
// least 15 % of the box. Own choices: a split is across an axis of at least half the longest one's length, and each
// child gets at least a quarter of the triangles. The sum of volumes alone would make lists, and long boxes where the
// edges of a mesh lie in rows.
namespace gpu_planning_scene::core::literature
{
namespace
{
constexpr float kEmptyShare = 0.15F;
constexpr float kLeastShare = 0.5F;  // of the longest axis, for a split across another axis
constexpr float kInfinity = std::numeric_limits<float>::infinity();

FloatBox boundsOf(const Triangle& t)
{
  FloatBox box;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto [lower, upper] = std::minmax({t[0][axis], t[1][axis], t[2][axis]});
    box.lower[axis] = floatBelow(lower);
    box.upper[axis] = floatAbove(upper);
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

float lengthOf(const FloatBox& box, int axis)
{
  return box.upper[axis] - box.lower[axis];
}

struct Split
{
  int axis = 0;
  std::ptrdiff_t count = 0;  ///< triangles of the first child
  float first_upper = 0.0F;  ///< upper side of the first child
  float second_lower = 0.0F;
  float cost = kInfinity;  ///< sum of the children's volumes, divided by that of the parent
};

/// Finds the best split along one axis. Sorts the triangles along it.
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
  const float longest = std::max({lengthOf(box, 0), lengthOf(box, 1), lengthOf(box, 2)});
  for (int axis = 0; axis < 3; ++axis)
    if (lengthOf(box, axis) >= kLeastShare * longest)
      trySplits(axis, box, bounds_, begin, end, best);
  if (Split again; best.cost < kInfinity)  // the triangles may be sorted along another axis
    trySplits(best.axis, box, bounds_, begin, end, again);
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
}  // namespace gpu_planning_scene::core::literature
