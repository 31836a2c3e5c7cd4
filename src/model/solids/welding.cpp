#include "model/solids/welding.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include <Eigen/Geometry>

#include "model/coordinate_hash.h"
#include "model/solids/disjoint_sets.h"

// Points within the tolerance are found with a hash grid whose cells are twice as long as the tolerance, so a point has
// its neighbours in at most eight cells.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// In tolerances. A longer chain is a fine edge and not a place.
constexpr double kLongestChain = 4.0;

/// Points of a cell that are compared with their neighbours. A cell with more of them has fine edges and no corners.
constexpr std::size_t kMostInCell = 64;
}  // namespace

Places placesOf(const std::vector<Vector3d>& vertices)
{
  std::unordered_map<Vector3d, std::uint32_t, CoordinateHash> numbers;
  numbers.reserve(vertices.size());
  Places places;
  places.of_vertex.reserve(vertices.size());
  for (const Vector3d& vertex : vertices)
  {
    const auto [entry, is_new] = numbers.try_emplace(vertex, static_cast<std::uint32_t>(places.points.size()));
    if (is_new)
      places.points.push_back(vertex);
    places.of_vertex.push_back(entry->second);
  }
  return places;
}

std::vector<std::uint32_t> weld(const std::vector<Vector3d>& points, const std::vector<bool>& used, double tolerance)
{
  DisjointSets sets(points.size());
  Eigen::AlignedBox3d all;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (used[i])
      all.extend(points[i]);
  // Numbers of cells are exact: the tolerance is at least a millionth of the extent.
  const Vector3d origin = all.isEmpty() ? Vector3d::Zero() : all.min();
  const double cell = std::max(2.0 * tolerance, 1e-9 * (all.isEmpty() ? 0.0 : all.diagonal().norm()));
  std::unordered_map<Vector3d, std::vector<std::uint32_t>, CoordinateHash> grid;
  for (std::uint32_t i = 0; i < points.size() && tolerance > 0.0; ++i)
  {
    if (!used[i])
      continue;
    const Vector3d low = (((points[i] - origin).array() - tolerance) / cell).floor();
    const Vector3d high = (((points[i] - origin).array() + tolerance) / cell).floor();
    for (double x = low.x(); x <= high.x(); ++x)
      for (double y = low.y(); y <= high.y(); ++y)
        for (double z = low.z(); z <= high.z(); ++z)
        {
          const auto found = grid.find({x, y, z});
          if (found == grid.end())
            continue;
          for (const std::uint32_t other : found->second)
            if ((points[other] - points[i]).norm() <= tolerance)
              sets.unite(other, i);
        }
    std::vector<std::uint32_t>& own = grid[((points[i] - origin).array() / cell).floor()];
    if (own.size() < kMostInCell)
      own.push_back(i);
  }
  std::vector<std::uint32_t> first(points.size());
  std::iota(first.begin(), first.end(), 0U);
  std::vector<Eigen::AlignedBox3d> box(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
  {
    const std::uint32_t set = sets.find(i);
    if (precedes(points[i], points[first[set]]))
      first[set] = i;
    box[set].extend(points[i]);
  }
  std::vector<std::uint32_t> representative(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    representative[i] = box[sets.find(i)].diagonal().norm() <= kLongestChain * tolerance ? first[sets.find(i)] : i;
  return representative;
}
}  // namespace gpu_planning_scene::core
