#include "model/solids/free_rims.h"

#include <map>
#include <queue>

// E. W. Dijkstra: A note on two problems in connexion with graphs. Numerische Mathematik 1, 1959.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr int kMostOpenEnds = 32;

/// The edges that have more than one triangle: the places to which edges lead from a place.
using EdgeGraph = std::map<std::uint32_t, std::vector<std::uint32_t>>;

/// The shortest path from a place to the nearest place that lacks an edge; empty if there is none.
std::vector<BoundaryEdge> shortestPath(const std::vector<Vector3d>& points, const EdgeGraph& edges, std::uint32_t from,
                                       const std::map<std::uint32_t, int>& balance)
{
  struct Step
  {
    double length;
    std::uint32_t place;
    std::uint32_t before;
    bool operator<(const Step& other) const
    {
      return length != other.length ? length > other.length : place > other.place;
    }
  };
  std::priority_queue<Step> open;
  std::map<std::uint32_t, std::uint32_t> before;
  open.push({0.0, from, from});
  while (!open.empty())
  {
    const Step step = open.top();
    open.pop();
    if (!before.try_emplace(step.place, step.before).second)
      continue;
    if (const auto end = balance.find(step.place); end != balance.end() && end->second > 0)
    {
      std::vector<BoundaryEdge> path;
      for (std::uint32_t place = step.place; place != from; place = before.at(place))
        path.push_back({before.at(place), place});
      return path;
    }
    if (const auto next = edges.find(step.place); next != edges.end())
      for (const std::uint32_t place : next->second)
        open.push({step.length + (points[place] - points[step.place]).norm(), place, step.place});
  }
  return {};
}
}  // namespace

std::vector<BoundaryEdge> freeRims(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles)
{
  std::vector<BoundaryEdge> rims;
  EdgeGraph edges;
  std::map<std::uint32_t, int> balance;  // of a place: edges that leave it minus edges that reach it
  visitEdges(
      edgeUses(triangles),
      [&](auto first, auto last)
      {
        if (last - first > 1)
        {
          edges[first->low].push_back(first->high);
          edges[first->high].push_back(first->low);
          return;
        }
        rims.push_back(first->upwards ? BoundaryEdge{first->low, first->high} : BoundaryEdge{first->high, first->low});
        ++balance[rims.back().from];
        --balance[rims.back().to];
      });
  int open_ends = 0;
  for (const auto& [place, sum] : balance)
    open_ends += std::abs(sum);
  if (open_ends > kMostOpenEnds)
    return {};
  for (auto& [place, sum] : balance)
    while (sum < 0)
    {
      const std::vector<BoundaryEdge> path = shortestPath(points, edges, place, balance);
      if (path.empty())
        return {};
      rims.insert(rims.end(), path.begin(), path.end());
      ++sum;
      --balance[path.front().to];
    }
  return rims;
}
}  // namespace gpu_planning_scene::core
