#include "model/solids/welding.h"

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
  const double cell = 2.0 * tolerance;
  std::unordered_map<Vector3d, std::vector<std::uint32_t>, CoordinateHash> grid;
  for (std::uint32_t i = 0; i < points.size() && tolerance > 0.0; ++i)
  {
    if (!used[i])
      continue;
    const Vector3d low = ((points[i].array() - tolerance) / cell).floor();
    const Vector3d high = ((points[i].array() + tolerance) / cell).floor();
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
    grid[(points[i].array() / cell).floor()].push_back(i);
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
