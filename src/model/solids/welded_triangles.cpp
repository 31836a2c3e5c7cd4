#include "model/solids/welded_triangles.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "model/solids/disjoint_sets.h"
#include "model/solids/orientation.h"
#include "model/solids/welding.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// The numbers of the triangles with distinct corners. Triangles with the same corners, in whatever direction, follow
/// each other in their order.
Numbers sortedByCorners(const std::vector<Corners>& triangles)
{
  std::vector<std::pair<Corners, std::uint32_t>> sorted;
  sorted.reserve(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    if (hasDistinctCorners(triangles[t]))
    {
      sorted.emplace_back(triangles[t], t);
      std::sort(sorted.back().first.begin(), sorted.back().first.end());
    }
  std::sort(sorted.begin(), sorted.end());
  Numbers numbers;
  numbers.reserve(sorted.size());
  for (const auto& [corners, t] : sorted)
    numbers.push_back(t);
  return numbers;
}

bool haveSameCorners(Corners a, Corners b)
{
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

/// Each triangle once.
std::vector<Corners> withoutCopies(const std::vector<Corners>& triangles)
{
  std::vector<Corners> once;
  for (const std::uint32_t t : sortedByCorners(triangles))
    if (once.empty() || !haveSameCorners(once.back(), triangles[t]))
      once.push_back(triangles[t]);
  return once;
}
}  // namespace

WeldedTriangles::WeldedTriangles(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles,
                                 double tolerance, WeldedCorners welded)
  : points_(points)
{
  std::vector<bool> used(points_.size(), false);
  if (welded == WeldedCorners::All)
  {
    for (const Corners& t : triangles)
      for (const std::uint32_t place : t)
        used[place] = true;
  }
  else
    visitEdges(edgeUses(withoutCopies(triangles)),
               [&](auto first, auto last)
               {
                 if ((last - first) % 2 == 1)
                   used[first->low] = used[first->high] = true;
               });
  representative_ = weld(points_, used, tolerance);
  for (const Corners& t : triangles)
    welded_.push_back({representative_[t[0]], representative_[t[1]], representative_[t[2]]});
  findCopies(triangles);
}

void WeldedTriangles::findCopies(const std::vector<Corners>& triangles)
{
  next_copy_.resize(welded_.size());
  std::iota(next_copy_.begin(), next_copy_.end(), 0U);
  std::uint32_t before = kNone;
  for (const std::uint32_t t : sortedByCorners(welded_))
  {
    if (before != kNone && haveSameCorners(welded_[before], welded_[t]))
      next_copy_[before] = t;
    else
      distinct_.push_back(t);
    before = t;
  }
  std::sort(distinct_.begin(), distinct_.end());
  for (std::uint32_t t = 0; t < welded_.size(); ++t)
    if (!hasDistinctCorners(welded_[t]) && hasDistinctCorners(triangles[t]))
      collapsed_.push_back(t);
}

Numbers WeldedTriangles::copies(std::uint32_t distinct) const
{
  Numbers copies = {distinct};
  while (hasCopies(copies.back()))
    copies.push_back(next_copy_[copies.back()]);
  return copies;
}

std::uint32_t WeldedTriangles::add(const Corners& triangle)
{
  const auto number = static_cast<std::uint32_t>(welded_.size());
  welded_.push_back(triangle);
  next_copy_.push_back(number);
  return number;
}

std::vector<Corners> WeldedTriangles::cornersOf(const Numbers& triangles) const
{
  std::vector<Corners> corners;
  corners.reserve(triangles.size());
  for (const std::uint32_t t : triangles)
    corners.push_back(welded_[t]);
  return corners;
}

double WeldedTriangles::areaOf(const Numbers& triangles) const
{
  double area = 0.0;
  for (const std::uint32_t t : triangles)
    area += core::areaOf(points_, welded_[t]);
  return area;
}

std::vector<Numbers> WeldedTriangles::partsOf(const Numbers& triangles, ConnectedBy connected) const
{
  DisjointSets sets(triangles.size());
  visitEdges(edgeUses(cornersOf(triangles)),
             [&](auto first, auto last)
             {
               for (auto use = first; use != last; ++use)
                 sets.unite(first->triangle, use->triangle);
             });
  if (connected == ConnectedBy::CommonCorners)
  {
    std::unordered_map<std::uint32_t, std::uint32_t> first_at;
    first_at.reserve(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
      for (const std::uint32_t place : welded_[triangles[i]])
        sets.unite(first_at.try_emplace(place, i).first->second, i);
  }
  std::vector<Numbers> parts = sets.sets();
  for (Numbers& part : parts)
    for (std::uint32_t& number : part)
      number = triangles[number];
  return parts;
}
}  // namespace gpu_planning_scene::core
