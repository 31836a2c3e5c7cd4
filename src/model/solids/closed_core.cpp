#include "model/solids/closed_core.h"

#include <bitset>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "model/solids/orientation.h"

// The surfaces with an even number of triangles at each edge are a vector space over the integers modulo 2 (J. R.
// Munkres, Elements of Algebraic Topology, 1984). Elimination gives a basis of it in terms of patches. Sums of basis
// vectors make the basis vectors small, like single chambers. Adding them to one another finds the outer surface.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// More patches than a mesh of chambers has; the time grows with the third power.
constexpr std::size_t kMostPatches = 256;
using Chosen = std::bitset<kMostPatches>;

/// Whether each triangle is taken away with the free edges.
std::vector<bool> peeled(const std::vector<Corners>& triangles, const std::vector<EdgeUse>& uses)
{
  struct Edge
  {
    std::size_t first;
    std::size_t left;
  };
  std::vector<Edge> edges;
  std::vector<std::array<std::size_t, 3>> edges_of(triangles.size());
  std::vector<int> known(triangles.size(), 0);
  for (std::size_t first = 0; first < uses.size();)
  {
    std::size_t last = first;
    for (; last < uses.size() && uses[last].sameEdge(uses[first]); ++last)
      edges_of[uses[last].triangle][known[uses[last].triangle]++] = edges.size();
    edges.push_back({first, last - first});
    first = last;
  }
  std::vector<bool> taken(triangles.size(), false);
  std::vector<std::size_t> open(edges.size());
  std::iota(open.begin(), open.end(), std::size_t{0});
  while (!open.empty())
  {
    const Edge edge = edges[open.back()];
    open.pop_back();
    if (edge.left != 1)
      continue;
    std::size_t use = edge.first;
    while (taken[uses[use].triangle])
      ++use;
    const std::uint32_t t = uses[use].triangle;
    taken[t] = true;
    for (const std::size_t e : edges_of[t])
    {
      --edges[e].left;
      open.push_back(e);
    }
  }
  return taken;
}

/// Surfaces without free edges, cut into patches along the edges of more than two triangles.
class PatchComplex
{
 public:
  PatchComplex(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles)
  {
    const OrientedSurface surface = orient(points, triangles);
    const std::vector<EdgeUse> uses = edgeUses(surface.triangles);
    findPatches(points, surface.triangles, uses);
    if (volumes_.size() <= kMostPatches)
      findPatchEdges(uses);
  }

  std::uint32_t patchOf(std::size_t triangle) const { return patch_of_[triangle]; }

  /// The patches of the closed surface that contains the most; none if there is no closed surface.
  Chosen largest() const
  {
    if (volumes_.size() > kMostPatches)
      return {};
    std::vector<Chosen> basis = closedBasis();
    std::vector<double> volumes;
    for (const Chosen& surface : basis)
      volumes.push_back(volumeOf(surface));
    // The gain ends the loops in spite of rounding.
    constexpr double kGain = 1e-9;
    for (bool changed = true; changed;)
    {
      changed = false;
      for (std::size_t i = 0; i < basis.size(); ++i)
        for (std::size_t k = 0; k < basis.size(); ++k)
          if (const double volume = i == k ? volumes[i] : volumeOf(basis[i] ^ basis[k]);
              volume < (1.0 - kGain) * volumes[i])
          {
            basis[i] ^= basis[k];
            volumes[i] = volume;
            changed = true;
          }
    }
    Chosen best;
    double most = 0.0;
    for (bool changed = true; changed;)
    {
      changed = false;
      for (const Chosen& surface : basis)
        if (const double volume = volumeOf(best ^ surface); volume > (1.0 + kGain) * most)
        {
          best ^= surface;
          most = volume;
          changed = true;
        }
    }
    return best;
  }

 private:
  /// Edges at which the same patches meet in the same way.
  struct PatchEdge
  {
    std::vector<std::pair<std::uint32_t, int>> sums;  // of each use, in ascending order: the patch; 1 upwards, else -1
    Chosen odd;                                       // patches with an odd number of uses; follows from `sums`

    bool operator<(const PatchEdge& other) const { return sums < other.sums; }
  };

  void findPatches(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles,
                   const std::vector<EdgeUse>& uses)
  {
    DisjointSets sets = patchSets(uses, triangles.size());
    constexpr std::uint32_t kNone = ~0U;
    std::vector<std::uint32_t> number_of_set(triangles.size(), kNone);
    const Vector3d origin = triangles.empty() ? Vector3d::Zero() : points[triangles[0][0]];
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      std::uint32_t& number = number_of_set[sets.find(static_cast<std::uint32_t>(t))];
      if (number == kNone)
      {
        number = static_cast<std::uint32_t>(volumes_.size());
        volumes_.push_back(0.0);
      }
      patch_of_.push_back(number);
      const Vector3d a = points[triangles[t][0]] - origin;
      volumes_[number] += a.dot((points[triangles[t][1]] - origin).cross(points[triangles[t][2]] - origin)) / 6.0;
    }
  }

  void findPatchEdges(const std::vector<EdgeUse>& uses)
  {
    std::set<PatchEdge> edges;
    visitEdges(uses,
               [&](auto first, auto last)
               {
                 if (last - first == 2)
                   return;
                 PatchEdge edge;
                 for (auto use = first; use != last; ++use)
                 {
                   const std::uint32_t patch = patch_of_[use->triangle];
                   edge.sums.emplace_back(patch, use->upwards ? 1 : -1);
                   edge.odd.flip(patch);
                 }
                 std::sort(edge.sums.begin(), edge.sums.end());
                 edges.insert(std::move(edge));
               });
    edges_.assign(edges.begin(), edges.end());
  }

  /// Gauss-Jordan elimination: each edge has an even number of the chosen patches' triangles.
  std::vector<Chosen> closedBasis() const
  {
    std::vector<std::pair<std::size_t, Chosen>> rows;  // pivot, equation
    for (const PatchEdge& edge : edges_)
    {
      Chosen row = edge.odd;
      for (const auto& [pivot, other] : rows)
        if (row[pivot])
          row ^= other;
      if (row.none())
        continue;
      std::size_t pivot = 0;
      while (!row[pivot])
        ++pivot;
      for (auto& [unused, other] : rows)
        if (other[pivot])
          other ^= row;
      rows.emplace_back(pivot, row);
    }
    Chosen dependent;
    for (const auto& [pivot, row] : rows)
      dependent.set(pivot);
    std::vector<Chosen> basis;
    for (std::size_t patch = 0; patch < volumes_.size(); ++patch)
    {
      if (dependent[patch])
        continue;
      Chosen& surface = basis.emplace_back();
      surface.set(patch);
      for (const auto& [pivot, row] : rows)
        if (row[patch])
          surface.set(pivot);
    }
    return basis;
  }

  /// The volume in a closed surface: patches are turned against their neighbours where two of the surface meet.
  double volumeOf(const Chosen& surface) const
  {
    struct Neighbour
    {
      std::uint32_t patch;
      bool turned;
    };
    std::vector<std::vector<Neighbour>> neighbours(volumes_.size());
    std::vector<std::pair<std::uint32_t, int>> sums;
    for (const PatchEdge& edge : edges_)
    {
      sums.clear();
      for (const auto& sum : edge.sums)
        if (surface[sum.first])
          sums.push_back(sum);
      if (sums.size() != 2)
        continue;
      const bool turned = sums[0].second == sums[1].second;
      neighbours[sums[0].first].push_back({sums[1].first, turned});
      neighbours[sums[1].first].push_back({sums[0].first, turned});
    }
    std::vector<bool> seen(volumes_.size(), false);
    std::vector<bool> turned(volumes_.size(), false);
    std::vector<std::uint32_t> members;
    double all = 0.0;
    for (std::uint32_t start = 0; start < volumes_.size(); ++start)
    {
      if (!surface[start] || seen[start])
        continue;
      members.assign(1, start);
      seen[start] = true;
      double volume = 0.0;
      for (std::size_t next = 0; next < members.size(); ++next)
      {
        const std::uint32_t patch = members[next];
        volume += turned[patch] ? -volumes_[patch] : volumes_[patch];
        for (const Neighbour& neighbour : neighbours[patch])
          if (!seen[neighbour.patch])
          {
            seen[neighbour.patch] = true;
            turned[neighbour.patch] = turned[patch] != neighbour.turned;
            members.push_back(neighbour.patch);
          }
      }
      all += std::abs(volume);
    }
    return all;
  }

  std::vector<std::uint32_t> patch_of_;  // of each triangle
  std::vector<double> volumes_;          // of each patch: of the pyramids between its triangles and a common point
  std::vector<PatchEdge> edges_;
};
}  // namespace

std::vector<CorePlace> closedCore(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles)
{
  const std::vector<bool> taken = peeled(triangles, edgeUses(triangles));
  std::vector<Corners> left;
  std::vector<std::size_t> numbers;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!taken[t])
    {
      left.push_back(triangles[t]);
      numbers.push_back(t);
    }
  std::vector<CorePlace> places(triangles.size(), CorePlace::Beside);
  bool is_even = true;
  visitEdges(edgeUses(left), [&](auto first, auto last) { is_even = is_even && (last - first) % 2 == 0; });
  if (is_even)
  {
    for (const std::size_t t : numbers)
      places[t] = CorePlace::Core;
    return places;
  }
  const PatchComplex patches(points, left);
  const Chosen largest = patches.largest();
  for (std::size_t i = 0; i < numbers.size() && largest.any(); ++i)
    places[numbers[i]] = largest[patches.patchOf(i)] ? CorePlace::Core : CorePlace::Wall;
  return places;
}
}  // namespace gpu_planning_scene::core
