#include "collision/exact/winding_number.h"

#include <array>
#include <optional>
#include <stdexcept>

#include "collision/geometry/exact_orientation.h"

// Sums the signed crossings of a segment from the point to a point outside of the mesh. If the segment meets an edge, a
// vertex or a coplanar triangle, another segment is tried. For triangles without a signed boundary, this sum is the
// winding number of Jacobson, Kavan and Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized Winding
// Numbers", 2013.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// Far above the rounding error of the box test, for coordinates of up to kilometres.
constexpr double kRayMargin = 1e-9;  // metres

/// Whether a segment and an oriented box overlap, by their separating axes (Ericson 2005). Never misses an overlap.
class SegmentBoxTest
{
 public:
  SegmentBoxTest(const Vector3d& start, const Vector3d& end) : center_(0.5 * (start + end)), half_(0.5 * (end - start))
  {
  }

  bool overlap(const OrientedBox& box) const
  {
    const Vector3d grown = box.half.array() + kRayMargin;
    const Vector3d between = box.axes.transpose() * (center_ - box.center);
    const Vector3d half = box.axes.transpose() * half_;
    const Vector3d abs_half = half.cwiseAbs();
    if ((between.cwiseAbs().array() > (grown + abs_half).array()).any())
      return false;
    const Vector3d across = between.cross(half).cwiseAbs();
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      if (across[i] > grown[j] * abs_half[k] + grown[k] * abs_half[j])
        return false;
    }
    return true;
  }

 private:
  Vector3d center_;
  Vector3d half_;
};

/// +1 or -1 if the segment passes through the inside of the triangle; the sign tells on which side it starts. 0 if the
/// segment does not meet the triangle. Empty if they meet in any other way.
std::optional<int> crossing(const Vector3d& start, const Vector3d& end, const Triangle& t)
{
  const std::array<int, 3> turns = {exactOrientation(start, end, t[0], t[1]), exactOrientation(start, end, t[1], t[2]),
                                    exactOrientation(start, end, t[2], t[0])};
  bool left = false;
  bool right = false;
  for (const int turn : turns)
  {
    left = left || turn > 0;
    right = right || turn < 0;
  }
  if (left && right)
    return 0;  // the line passes outside the triangle
  const int start_side = exactOrientation(t[0], t[1], t[2], start);
  const int end_side = exactOrientation(t[0], t[1], t[2], end);
  if (start_side * end_side > 0)
    return 0;
  if (turns[0] == 0 || turns[1] == 0 || turns[2] == 0 || start_side * end_side == 0)
    return {};
  return start_side;
}

/// Whether the crossings of the segment, which ends outside the mesh, put its start inside the solid; empty if a
/// crossing is degenerate.
std::optional<bool> startsInside(const CpuTree& tree, const Vector3d& start, const Vector3d& end,
                                 std::vector<std::uint32_t>& stack)
{
  const SegmentBoxTest test(start, end);
  int winding = 0;
  bool is_odd = false;
  stack.assign(1, 0);
  while (!stack.empty())
  {
    const CpuNode& node = tree.nodes[stack.back()];
    stack.pop_back();
    if (!test.overlap(node.box))
      continue;
    if (!node.isLeaf())
    {
      stack.push_back(node.first);
      stack.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    {
      if (tree.roles[i] == TriangleRole::Surface)
        continue;
      const std::optional<int> found = crossing(start, end, tree.triangles[i]);
      if (!found)
        return {};
      if (tree.roles[i] == TriangleRole::Winding)
        winding += *found;
      else
        is_odd = is_odd != (*found != 0);
    }
  }
  return winding != 0 || is_odd;
}

/// A point outside the bounds, near the face of the bounds that is nearest to `point`. Each attempt gives another
/// direction.
Vector3d pointOutside(const Eigen::AlignedBox3d& bounds, const Vector3d& point, int attempt)
{
  int axis;
  const double above = (bounds.max() - point).minCoeff(&axis);
  int axis_below;
  const double below = (point - bounds.min()).minCoeff(&axis_below);
  const double size = bounds.sizes().maxCoeff();
  Vector3d end = point;
  // The fractional parts of the multiples of an irrational number never repeat.
  const auto slant = [attempt, size](double irrational)
  {
    const double multiple = (attempt + 1) * irrational;
    return 0.2 * size * (multiple - static_cast<double>(static_cast<int>(multiple)) - 0.5);
  };
  const double beyond = 0.1 * size + 1e-3;
  const int chosen = above < below ? axis : axis_below;
  end[(chosen + 1) % 3] += slant(0.6180339887498949);
  end[(chosen + 2) % 3] += slant(0.4142135623730951);
  end[chosen] = above < below ? bounds.max()[chosen] + beyond : bounds.min()[chosen] - beyond;
  return end;
}
}  // namespace

bool isInsideSolid(const CpuTree& tree, const Vector3d& point, std::vector<std::uint32_t>& stack)
{
  const Eigen::AlignedBox3d& bounds = tree.solid_bounds;
  if (!bounds.contains(point))
    return false;
  constexpr int kMaxAttempts = 1000;
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt)
  {
    const std::optional<bool> inside = startsInside(tree, point, pointOutside(bounds, point, attempt), stack);
    if (inside)
      return *inside;
  }
  throw std::logic_error("the winding number was requested at a point on the surface of the mesh");
}
}  // namespace gpu_planning_scene::core
