#include "model/solids/orientation.h"

#include <array>
#include <cstddef>
#include <utility>

#include <Eigen/Geometry>

// Breadth-first search over the edges with two triangles, then a descent over the directions of the patches. Own
// method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

constexpr int kMostRounds = 20;  // of the descent; each round visits all patches

/// The triangles beside a triangle, at most one at each of its edges.
struct Neighbours
{
  std::array<std::uint32_t, 3> triangles;
  std::array<bool, 3> turned;  // the two triangles run along their edge in the same direction
  std::size_t count = 0;

  void add(std::uint32_t triangle, bool is_turned)
  {
    triangles[count] = triangle;
    turned[count++] = is_turned;
  }
};

/// The patches of a surface and, for each triangle, whether it is turned against the first one of its patch.
struct Patches
{
  std::vector<std::uint32_t> of_triangle;
  std::vector<bool> turned;
  std::size_t count = 0;
};

Patches findPatches(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles,
                    const std::vector<EdgeUse>& uses)
{
  std::vector<Neighbours> neighbours(triangles.size());
  visitEdges(uses,
             [&](auto first, auto last)
             {
               if (last - first != 2)
                 return;
               const EdgeUse& a = first[0];
               const EdgeUse& b = first[1];
               neighbours[a.triangle].add(b.triangle, a.upwards == b.upwards);
               neighbours[b.triangle].add(a.triangle, a.upwards == b.upwards);
             });
  constexpr std::uint32_t kNone = ~0U;
  Patches patches{std::vector<std::uint32_t>(triangles.size(), kNone), std::vector<bool>(triangles.size(), false)};
  std::vector<std::uint32_t> members;
  for (std::uint32_t start = 0; start < triangles.size(); ++start)
  {
    if (patches.of_triangle[start] != kNone)
      continue;
    const auto patch = static_cast<std::uint32_t>(patches.count++);
    members.assign(1, start);
    patches.of_triangle[start] = patch;
    double kept = 0.0;
    for (std::size_t next = 0; next < members.size(); ++next)
    {
      const std::uint32_t t = members[next];
      kept += (patches.turned[t] ? -1.0 : 1.0) * areaOf(points, triangles[t]);
      for (std::size_t i = 0; i < neighbours[t].count; ++i)
        if (const std::uint32_t neighbour = neighbours[t].triangles[i]; patches.of_triangle[neighbour] == kNone)
        {
          patches.of_triangle[neighbour] = patch;
          patches.turned[neighbour] = patches.turned[t] != neighbours[t].turned[i];
          members.push_back(neighbour);
        }
    }
    if (kept < 0.0)
      for (const std::uint32_t t : members)
        patches.turned[t] = !patches.turned[t];
  }
  return patches;
}

/// Turns whole patches while that shortens the boundary: the sum over all edges of their length times how much more
/// often they are used in one direction than in the other.
void turnPatches(const std::vector<Vector3d>& points, const std::vector<EdgeUse>& uses, Patches& patches)
{
  struct Share
  {
    std::uint32_t edge;
    int sum;  // of the patch's uses: +1 upwards, -1 downwards
  };
  std::vector<double> lengths;
  std::vector<int> sums;
  std::vector<std::vector<Share>> shares(patches.count);
  visitEdges(
      uses,
      [&](auto first, auto last)
      {
        if (last - first == 2 && patches.of_triangle[first[0].triangle] == patches.of_triangle[first[1].triangle])
          return;
        const auto edge = static_cast<std::uint32_t>(sums.size());
        int sum = 0;
        for (auto use = first; use != last; ++use)
        {
          const int direction = use->upwards != patches.turned[use->triangle] ? 1 : -1;
          sum += direction;
          std::vector<Share>& share = shares[patches.of_triangle[use->triangle]];
          if (share.empty() || share.back().edge != edge)
            share.push_back({edge, 0});
          share.back().sum += direction;
        }
        sums.push_back(sum);
        lengths.push_back((points[first->high] - points[first->low]).norm());
      });
  std::vector<bool> turn(patches.count, false);
  bool changed = true;
  for (int round = 0; round < kMostRounds && changed; ++round)
  {
    changed = false;
    for (std::size_t patch = 0; patch < patches.count; ++patch)
    {
      double gain = 0.0;
      double length = 0.0;
      for (const Share& share : shares[patch])
      {
        gain += lengths[share.edge] * (std::abs(sums[share.edge]) - std::abs(sums[share.edge] - 2 * share.sum));
        length += lengths[share.edge];
      }
      if (!(gain > 1e-9 * length))
        continue;
      changed = true;
      turn[patch] = !turn[patch];
      for (Share& share : shares[patch])
      {
        sums[share.edge] -= 2 * share.sum;
        share.sum = -share.sum;
      }
    }
  }
  for (std::size_t t = 0; t < patches.turned.size(); ++t)
    patches.turned[t] = patches.turned[t] != turn[patches.of_triangle[t]];
}
}  // namespace

Vector3d areaNormal(const std::vector<Vector3d>& points, const Corners& t)
{
  return (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
}

double areaOf(const std::vector<Vector3d>& points, const Corners& t)
{
  return 0.5 * areaNormal(points, t).norm();
}

std::vector<BoundaryEdge> signedBoundary(const std::vector<Corners>& triangles)
{
  std::vector<BoundaryEdge> boundary;
  visitEdges(edgeUses(triangles),
             [&](auto first, auto last)
             {
               int sum = 0;
               for (auto use = first; use != last; ++use)
                 sum += use->upwards ? 1 : -1;
               for (; sum > 0; --sum)
                 boundary.push_back({first->low, first->high});
               for (; sum < 0; ++sum)
                 boundary.push_back({first->high, first->low});
             });
  return boundary;
}

OrientedSurface orient(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles)
{
  const std::vector<EdgeUse> uses = edgeUses(triangles);
  Patches patches = findPatches(points, triangles, uses);
  if (patches.count > 1)
    turnPatches(points, uses, patches);
  std::vector<Corners> turned = triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (patches.turned[t])
      std::swap(turned[t][1], turned[t][2]);
  return asOriented(std::move(turned));
}

OrientedSurface asOriented(std::vector<Corners> triangles)
{
  OrientedSurface surface;
  surface.boundary = signedBoundary(triangles);
  visitEdges(edgeUses(triangles),
             [&](auto first, auto last) { surface.even = surface.even && (last - first) % 2 == 0; });
  surface.triangles = std::move(triangles);
  return surface;
}
}  // namespace gpu_planning_scene::core
