#include "model/solids/welded_triangles.h"

#include <algorithm>
#include <map>
#include <utility>

#include "model/solids/disjoint_sets.h"
#include "model/solids/orientation.h"
#include "model/solids/welding.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// Each triangle once, in whatever direction.
std::vector<Corners> withoutCopies(const std::vector<Corners>& triangles)
{
  std::vector<std::pair<Corners, std::uint32_t>> sorted;
  sorted.reserve(triangles.size());
  for (const Corners& t : triangles)
  {
    sorted.emplace_back(t, static_cast<std::uint32_t>(sorted.size()));
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Corners> once;
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (i == 0 || sorted[i].first != sorted[i - 1].first)
      once.push_back(triangles[sorted[i].second]);
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
  countCopies(triangles);
}

void WeldedTriangles::countCopies(const std::vector<Corners>& triangles)
{
  std::map<Corners, std::uint32_t> first_with;
  copies_.resize(welded_.size());
  for (std::uint32_t t = 0; t < welded_.size(); ++t)
  {
    if (!hasDistinctCorners(welded_[t]))
    {
      if (hasDistinctCorners(triangles[t]))
        collapsed_.push_back(t);
      continue;
    }
    Corners sorted = welded_[t];
    std::sort(sorted.begin(), sorted.end());
    const auto [first, is_new] = first_with.try_emplace(sorted, t);
    if (is_new)
      distinct_.push_back(t);
    copies_[first->second].push_back(t);
  }
}

std::uint32_t WeldedTriangles::add(const Corners& triangle)
{
  const auto number = static_cast<std::uint32_t>(welded_.size());
  welded_.push_back(triangle);
  copies_.push_back({number});
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
    std::map<std::uint32_t, std::uint32_t> first_at;
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
