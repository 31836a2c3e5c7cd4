#include "model/solids/missed_places.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "model/solids/largest_triangles.h"
#include "model/solids/line_crossing.h"

// A place seems to be enclosed if rays in many directions all meet a triangle. Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// Distance of a place from its triangle, as a share of the triangle's size.
constexpr double kBeside = 1e-3;
/// Crossings of a ray and a triangle to compute, about: a tenth of a second.
constexpr std::size_t kMostCrossings = 20'000'000;
constexpr std::size_t kRaysOfAPlace = 8;  // most places are outside, and the first rays show it

/// Directions of rays, off the axes, along which edges often run.
const std::vector<Vector3d>& directions()
{
  static const std::vector<Vector3d> all = []
  {
    std::vector<Vector3d> made;
    for (const int x : {-1, 0, 1})
      for (const int y : {-1, 0, 1})
        for (const int z : {-1, 0, 1})
          if (x != 0 || y != 0 || z != 0)
            made.emplace_back(x + 0.0671, y - 0.0913, z + 0.0397);
    return made;
  }();
  return all;
}

bool isInside(const std::vector<Vector3d>& points, const std::vector<Corners>& cycle, const Vector3d& place)
{
  for (const Vector3d& direction : directions())
    if (const std::optional<int> winding = windingNumber({place, direction}, points, cycle))
      return *winding != 0;
  return true;  // not known, so the place is not counted
}

bool seemsEnclosed(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles, const Vector3d& place)
{
  return std::all_of(
      directions().begin(), directions().end(),
      [&](const Vector3d& direction)
      {
        return std::any_of(
            triangles.begin(), triangles.end(),
            [&](const Corners& t)
            {
              const LineCrossing met = crossing({place, direction}, points, t);
              return met.kind == LineCrossing::NearBorder || (met.kind == LineCrossing::Certain && met.at > 0.0);
            });
      });
}
}  // namespace

std::size_t countMissedPlaces(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles,
                              const std::vector<Corners>& cycle)
{
  DisjointSets patches = patchSets(edgeUses(triangles), triangles.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> members;
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    members.emplace_back(patches.find(t), t);
  const std::size_t most = 1 + kMostCrossings / (2 * kRaysOfAPlace * triangles.size() + 1);
  std::size_t missed = 0;
  for (const std::uint32_t number : largestOfSets(points, triangles, members, most))
  {
    const Corners& t = triangles[number];
    const Vector3d normal = areaNormal(points, t);
    for (const double side : {-kBeside, kBeside})
    {
      const Vector3d place = pointWithin(points, t) + side * std::sqrt(normal.norm()) * normal.normalized();
      if (!isInside(points, cycle, place) && seemsEnclosed(points, triangles, place))
        ++missed;
    }
  }
  return missed;
}
}  // namespace gpu_planning_scene::core
