#include "model/solids/hole_filling.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "model/solids/welding.h"

// The filling of least area: G. Barequet, M. Sharir: Filling gaps in the boundary of a polyhedron. Computer Aided
// Geometric Design 12(2), 1995. It takes cubic time; longer rims are filled by cutting off the smallest corner again
// and again.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;
using Rim = std::vector<std::uint32_t>;

constexpr std::size_t kLongestRim = 128;  // for the filling of least area: some milliseconds

/// Walks along the reversed boundary edges. Whenever a place is reached for the second time, the walk since the first
/// time is a loop. At a branch, the walk takes the target that is first in lexicographic order.
std::vector<Rim> loopsOf(const std::vector<Vector3d>& points, const std::vector<BoundaryEdge>& boundary)
{
  const auto before = [&](std::uint32_t a, std::uint32_t b) { return precedes(points[a], points[b]); };
  std::map<std::uint32_t, std::vector<std::uint32_t>, decltype(before)> targets(before);
  for (const BoundaryEdge& edge : boundary)
    targets[edge.to].push_back(edge.from);
  for (auto& [from, ends] : targets)
    std::sort(ends.begin(), ends.end(), [&](std::uint32_t a, std::uint32_t b) { return before(b, a); });

  std::vector<Rim> loops;
  for (auto& [start, ends] : targets)
    while (!ends.empty())
    {
      Rim walk = {start};
      std::map<std::uint32_t, std::size_t> step_of = {{start, 0}};
      while (!walk.empty())
      {
        std::vector<std::uint32_t>& next_ends = targets.find(walk.back())->second;
        // A walk of a cycle never ends before it is closed.
        const std::uint32_t next = next_ends.back();
        next_ends.pop_back();
        const auto [known, is_new] = step_of.try_emplace(next, walk.size());
        if (is_new)
        {
          walk.push_back(next);
          continue;
        }
        const auto first = walk.begin() + static_cast<std::ptrdiff_t>(known->second);
        loops.emplace_back(first, walk.end());
        for (auto place = first + 1; place != walk.end(); ++place)
          step_of.erase(*place);
        walk.erase(first + 1, walk.end());
        if (walk.size() == 1)
          break;
      }
    }
  for (Rim& loop : loops)
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end(), before), loop.end());
  return loops;
}

void fillByLeastArea(const std::vector<Vector3d>& points, FilledHole& hole)
{
  const Rim& rim = hole.rim;
  const std::size_t n = rim.size();
  std::vector<double> least(n * n, 0.0);
  std::vector<std::size_t> apex(n * n, 0);
  for (std::size_t span = 2; span < n; ++span)
    for (std::size_t i = 0; i + span < n; ++i)
    {
      const std::size_t k = i + span;
      double& best = least[i * n + k];
      best = std::numeric_limits<double>::max();
      for (std::size_t j = i + 1; j < k; ++j)
      {
        const double area = least[i * n + j] + least[j * n + k] + areaOf(points, {rim[i], rim[j], rim[k]});
        if (area < best)
        {
          best = area;
          apex[i * n + k] = j;
        }
      }
    }
  std::vector<std::array<std::size_t, 2>> open = {{0, n - 1}};
  while (!open.empty())
  {
    const auto [i, k] = open.back();
    open.pop_back();
    if (k - i < 2)
      continue;
    const std::size_t j = apex[i * n + k];
    hole.triangles.push_back({rim[i], rim[j], rim[k]});
    open.push_back({i, j});
    open.push_back({j, k});
  }
}

void fillBySmallestCorner(const std::vector<Vector3d>& points, FilledHole& hole)
{
  const Rim& rim = hole.rim;
  const std::size_t n = rim.size();
  std::vector<std::size_t> previous(n);
  std::vector<std::size_t> next(n);
  std::vector<double> area(n);
  std::set<std::tuple<double, std::size_t>> corners;
  for (std::size_t i = 0; i < n; ++i)
  {
    previous[i] = (i + n - 1) % n;
    next[i] = (i + 1) % n;
    area[i] = areaOf(points, {rim[previous[i]], rim[i], rim[next[i]]});
    corners.emplace(area[i], i);
  }
  for (std::size_t left = n; left >= 3; --left)
  {
    const std::size_t i = std::get<1>(*corners.begin());
    corners.erase(corners.begin());
    hole.triangles.push_back({rim[previous[i]], rim[i], rim[next[i]]});
    next[previous[i]] = next[i];
    previous[next[i]] = previous[i];
    for (const std::size_t k : {previous[i], next[i]})
    {
      corners.erase({area[k], k});
      area[k] = areaOf(points, {rim[previous[k]], rim[k], rim[next[k]]});
      corners.emplace(area[k], k);
    }
  }
}
}  // namespace

std::vector<FilledHole> fillHoles(const std::vector<Vector3d>& points, const std::vector<BoundaryEdge>& boundary,
                                  FillingBudget& budget)
{
  std::vector<FilledHole> holes;
  for (Rim& loop : loopsOf(points, boundary))
  {
    FilledHole& hole = holes.emplace_back();
    hole.rim = std::move(loop);
    const auto length = static_cast<double>(hole.rim.size());
    const double steps = length * length * length / 6.0;
    if (hole.rim.size() <= kLongestRim && steps <= budget.steps)
    {
      fillByLeastArea(points, hole);
      budget.steps -= steps;
    }
    else
      fillBySmallestCorner(points, hole);
    for (const Corners& triangle : hole.triangles)
      hole.area += areaOf(points, triangle);
  }
  return holes;
}
}  // namespace gpu_planning_scene::core
