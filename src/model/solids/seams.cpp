#include "model/solids/seams.h"

#include <cmath>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include "model/coordinate_hash.h"
#include "model/solids/welding.h"

// T-junctions are found with a grid over the ends of the free edges. Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// A mesh of many long separate triangles would take minutes. Its seams are not worth them: it bounds no solid.
constexpr std::size_t kMostSteps = 30'000'000;

/// In seams, an end lies on one edge, seldom on two or three. Where it lies on more of them, edges of a line lie upon
/// one another, and triangles between them would be as many as pairs of edges.
constexpr std::size_t kMostEdgesOfAnEnd = 8;

/// A grid of cubes, about one for each point. A long edge visits at most some thousand cubes.
class PointGrid
{
 public:
  PointGrid(const std::vector<Vector3d>& points, const std::vector<std::uint32_t>& numbers) : points_(points)
  {
    AlignedBox3d box;
    for (const std::uint32_t i : numbers)
      box.extend(points[i]);
    const double cells = std::min(32.0, std::cbrt(static_cast<double>(numbers.size())) + 1.0);
    cell_ = std::max(box.sizes().maxCoeff(), 1e-300) / cells;
    origin_ = box.min();
    for (const std::uint32_t i : numbers)
      cubes_[cubeOf(points[i])].push_back(i);
  }

  /// Calls visit(number, point) for the points near the box. Returns the number of cubes and points that were looked
  /// at.
  template <class Visit>
  std::size_t each(const AlignedBox3d& box, const Visit& visit) const
  {
    std::size_t steps = 0;
    const Vector3d low = cubeOf(box.min());
    const Vector3d high = cubeOf(box.max());
    for (double x = low.x(); x <= high.x(); ++x)
      for (double y = low.y(); y <= high.y(); ++y)
        for (double z = low.z(); z <= high.z(); ++z)
        {
          const auto found = cubes_.find({x, y, z});
          ++steps;
          if (found == cubes_.end())
            continue;
          steps += found->second.size();
          for (const std::uint32_t i : found->second)
            visit(i, points_[i]);
        }
    return steps;
  }

 private:
  Vector3d cubeOf(const Vector3d& point) const { return ((point - origin_) / cell_).array().floor(); }

  const std::vector<Vector3d>& points_;
  double cell_ = 1.0;
  Vector3d origin_;
  std::unordered_map<Vector3d, std::vector<std::uint32_t>, CoordinateHash> cubes_;
};
}  // namespace

std::vector<Corners> seamTriangles(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles,
                                   double tolerance)
{
  const std::vector<EdgeUse> uses = edgeUses(triangles);
  std::vector<EdgeUse> free_edges;
  visitEdges(uses,
             [&](auto first, auto last)
             {
               if ((last - first) % 2 == 1)
                 free_edges.push_back(*first);
             });
  std::vector<std::uint32_t> ends;
  for (const EdgeUse& edge : free_edges)
    ends.insert(ends.end(), {edge.low, edge.high});
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<Corners> added;
  if (ends.empty())
    return added;
  const PointGrid grid(points, ends);
  std::size_t steps = 0;
  for (const EdgeUse& edge : free_edges)
  {
    if (steps > kMostSteps || added.size() > kMostEdgesOfAnEnd * ends.size())
      break;
    const std::uint32_t from = edge.upwards ? edge.low : edge.high;
    const std::uint32_t to = edge.upwards ? edge.high : edge.low;
    const Vector3d along = points[to] - points[from];
    const double length = along.norm();
    if (!(length > 2.0 * tolerance))
      continue;
    AlignedBox3d box(points[from]);
    box.extend(points[to]);
    const Vector3d around = Vector3d::Constant(tolerance);
    std::vector<std::pair<double, std::uint32_t>> between;
    steps += grid.each(
        {box.min() - around, box.max() + around},
        [&](std::uint32_t i, const Vector3d& point)
        {
          const double at = (point - points[from]).dot(along) / length;
          if (at > tolerance && at < length - tolerance &&
              (points[from] + at / length * along - point).norm() <= tolerance)
            between.emplace_back(at, i);
        });
    std::sort(between.begin(), between.end(),
              [&](const auto& a, const auto& b)
              { return a.first != b.first ? a.first < b.first : precedes(points[a.second], points[b.second]); });
    // The edge's triangle runs from `from` to `to`; a fan around `from` continues along the ends instead.
    for (std::size_t i = 0; i < between.size(); ++i)
      added.push_back({from, between[i].second, i + 1 < between.size() ? between[i + 1].second : to});
  }
  return added;
}
}  // namespace gpu_planning_scene::core
