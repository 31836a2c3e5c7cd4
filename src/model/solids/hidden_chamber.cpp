#include "model/solids/hidden_chamber.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include <Eigen/Geometry>

// A place seems to be enclosed if rays in many directions all meet a triangle. The winding number is a sum of solid
// angles (A. van Oosterom, J. Strackee: The solid angle of a plane triangle. IEEE Transactions on Biomedical
// Engineering 30(2), 1983).
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// Solid angles to compute: of more patches than these allow, only those with the largest triangles are looked at.
constexpr std::size_t kMostAngles = 50'000'000;
/// Distance of a place from its triangle, as a share of the triangle's size.
constexpr double kBeside = 1e-3;

Vector3d normalOf(const std::vector<Vector3d>& points, const Corners& t)
{
  return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
}

bool isInside(const std::vector<Vector3d>& points, const std::vector<Corners>& chain, const Vector3d& place)
{
  double sum = 0.0;
  for (const Corners& t : chain)
  {
    const Vector3d a = points[t[0]] - place;
    const Vector3d b = points[t[1]] - place;
    const Vector3d c = points[t[2]] - place;
    const double lengths[] = {a.norm(), b.norm(), c.norm()};
    sum += std::atan2(a.dot(b.cross(c)), lengths[0] * lengths[1] * lengths[2] + a.dot(b) * lengths[2] +
                                             b.dot(c) * lengths[0] + c.dot(a) * lengths[1]);
  }
  return std::abs(sum) > M_PI;  // half a full turn: the terms are half solid angles
}

bool meets(const std::vector<Vector3d>& points, const Corners& t, const Vector3d& origin, const Vector3d& direction)
{
  const Vector3d a = points[t[0]] - origin;
  const Vector3d b = points[t[1]] - origin;
  const Vector3d c = points[t[2]] - origin;
  const double weights[] = {direction.dot(b.cross(c)), direction.dot(c.cross(a)), direction.dot(a.cross(b))};
  const double sum = weights[0] + weights[1] + weights[2];
  const double sign = sum < 0.0 ? -1.0 : 1.0;
  return std::all_of(std::begin(weights), std::end(weights), [sign](double weight) { return sign * weight >= 0.0; }) &&
         sign * a.dot(normalOf(points, t)) > 0.0;
}

bool seemsEnclosed(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles, const Vector3d& place)
{
  for (double x = -1.0; x < 2.0; x += 1.0)
    for (double y = -1.0; y < 2.0; y += 1.0)
      for (double z = -1.0; z < 2.0; z += 1.0)
      {
        if (x == 0.0 && y == 0.0 && z == 0.0)
          continue;
        // Off the axes, along which edges often run.
        const Vector3d direction(x + 0.0671, y - 0.0913, z + 0.0397);
        if (std::none_of(triangles.begin(), triangles.end(),
                         [&](const Corners& t) { return meets(points, t, place, direction); }))
          return false;
      }
  return true;
}
}  // namespace

std::size_t hiddenChambers(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles,
                           const std::vector<Corners>& chain)
{
  DisjointSets patches = patchSets(edgeUses(triangles), triangles.size());
  std::map<std::uint32_t, std::uint32_t> largest;  // triangle of each patch
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    if (std::uint32_t& known = largest.try_emplace(patches.find(t), t).first->second;
        normalOf(points, triangles[t]).squaredNorm() > normalOf(points, triangles[known]).squaredNorm())
      known = t;
  std::vector<std::uint32_t> numbers;
  for (const auto& [unused, number] : largest)
    numbers.push_back(number);
  std::sort(numbers.begin(), numbers.end(),
            [&](std::uint32_t a, std::uint32_t b)
            { return normalOf(points, triangles[a]).squaredNorm() > normalOf(points, triangles[b]).squaredNorm(); });
  numbers.resize(std::min(numbers.size(), 1 + kMostAngles / (2 * chain.size() + 1)));
  std::size_t hidden = 0;
  for (const std::uint32_t number : numbers)
  {
    const Corners& t = triangles[number];
    const Vector3d normal = normalOf(points, t);
    const double size = std::sqrt(normal.norm());
    for (const double side : {-kBeside, kBeside})
    {
      const Vector3d place =
          0.31 * points[t[0]] + 0.36 * points[t[1]] + 0.33 * points[t[2]] + side * size * normal.normalized();
      if (!isInside(points, chain, place) && seemsEnclosed(points, triangles, place))
        ++hidden;
    }
  }
  return hidden;
}
}  // namespace gpu_planning_scene::core
