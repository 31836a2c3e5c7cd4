#include "collision/proofs/moving_pair.h"

#include <algorithm>
#include <array>

#include "collision/geometry/cpu_box_pair.h"

// A simultaneous traversal of both trees as in CpuShapePair. Two nodes must be apart by the displacement bound of the
// second body's node. So parts near the axes need less distance than parts far from the axes. The header names the
// source of the bound; a bound for each node is our own method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kBoundMargin = 1e-8;      // metres: exceeds the rounding error of bounds and distances
constexpr std::size_t kMostSteps = 20000;  // pairs of nodes
constexpr unsigned kStepsPerStopTest = 64;

bool leavesApart(const CpuTree& a, const CpuNode& node_a, const CpuTree& b, const CpuNode& node_b,
                 const Isometry3d& b_in_a, const std::vector<JointAxis>& axes, double margin)
{
  for (std::uint32_t j = node_b.first; j < node_b.first + node_b.count; ++j)
  {
    const Triangle& t = b.triangles[j];
    const Triangle triangle = {b_in_a * t[0], b_in_a * t[1], b_in_a * t[2]};
    const Vector3d center = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
    const double radius =
        std::max({(triangle[0] - center).norm(), (triangle[1] - center).norm(), (triangle[2] - center).norm()});
    const double required = displacementBound(axes, center, radius) + margin;
    for (std::uint32_t i = node_a.first; i < node_a.first + node_a.count; ++i)
      if (trianglesWithin(a.triangles[i], triangle, required))
        return false;
  }
  return true;
}
}  // namespace

/// The joint nearest to the second body moves the points first. The next joint then moves the displaced points, and so
/// on.
double displacementBound(const std::vector<JointAxis>& axes, const Vector3d& center, double radius)
{
  double displacement = 0.0;
  for (auto axis = axes.rbegin(); axis != axes.rend(); ++axis)
  {
    const Vector3d offset = center - axis->point;
    const double distance = (offset - axis->direction * axis->direction.dot(offset)).norm();
    displacement += axis->travel * (axis->prismatic ? 1.0 : distance + radius + displacement);
  }
  return displacement;
}

bool surfacesApartWhileMoving(const CpuTree& a, const CpuTree& b, const Isometry3d& b_in_a,
                              const std::vector<JointAxis>& axes, double required, std::uint64_t& steps,
                              const Stopped& stopped)
{
  const double margin = required + kBoundMargin;
  StopTest end_if_stopped(stopped, kStepsPerStopTest);
  std::vector<std::array<std::uint32_t, 2>> pairs(1, {0, 0});
  for (std::size_t visited = 0; !pairs.empty(); ++visited)
  {
    if (visited == kMostSteps)
      return false;
    end_if_stopped();
    ++steps;
    const auto [index_a, index_b] = pairs.back();
    pairs.pop_back();
    const CpuNode& node_a = a.nodes[index_a];
    const CpuNode& node_b = b.nodes[index_b];
    const OrientedBox box = placed(node_b.box, b_in_a);
    const double distance = displacementBound(axes, box.center, box.half.norm()) + margin;
    if (!overlap(node_a.box, box, distance) || apartAlongCenters(node_a.box, box, distance))
      continue;
    if (node_a.isLeaf() && node_b.isLeaf())
    {
      if (!leavesApart(a, node_a, b, node_b, b_in_a, axes, margin))
        return false;
      continue;
    }
    const bool open_a = opensFirst(node_a, node_b);
    const std::uint32_t first = open_a ? node_a.first : node_b.first;
    for (const std::uint32_t child : {first, first + 1})
      pairs.push_back({open_a ? child : index_a, open_a ? index_b : child});
  }
  return true;
}
}  // namespace gpu_planning_scene::core
