#include "model/solids/shells.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "model/solids/line_crossing.h"

// Shells form a forest: the parent of a shell is the smallest one that it lies in. From the roots on, a shell adds 1 to
// the winding number, or takes 1 away if it is a cavity. Triangles are apart if an axis separates them (S. Gottschalk:
// Separating axis theorem, 1996). A shell that is not proven to lie in another one is no cavity, so doubt makes a solid
// larger. Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr std::size_t kMostComparisons = 300'000'000;  // comparisons of boxes: about a second
constexpr double kShareOfRounding = 1e-12;             // of gaps and areas, as a share of the lengths in them

struct Shell
{
  std::vector<std::uint32_t> triangles;
  AlignedBox3d box;
  double volume = 0.0;  // cubic metres; negative: inside out
  int winding = 1;      // in the shell, after turning
  bool turned = false;

  double squaredDiagonal() const { return box.diagonal().squaredNorm(); }
};

bool liesStrictlyIn(const AlignedBox3d& inner, const AlignedBox3d& outer)
{
  return (outer.min().array() < inner.min().array()).all() && (inner.max().array() < outer.max().array()).all();
}

/// Whether an axis certainly separates two triangles.
bool areApart(const std::array<Vector3d, 3>& a, const std::array<Vector3d, 3>& b)
{
  const std::array<Vector3d, 3> edges_a = {a[1] - a[0], a[2] - a[1], a[0] - a[2]};
  const std::array<Vector3d, 3> edges_b = {b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  const auto separates = [&](const Vector3d& axis)
  {
    double low_a = 0.0, high_a = 0.0, low_b = axis.dot(b[0] - a[0]), high_b = low_b, size = std::abs(low_b);
    for (int i = 1; i < 3; ++i)
    {
      const double at_a = axis.dot(a[i] - a[0]);
      const double at_b = axis.dot(b[i] - a[0]);
      low_a = std::min(low_a, at_a);
      high_a = std::max(high_a, at_a);
      low_b = std::min(low_b, at_b);
      high_b = std::max(high_b, at_b);
      size = std::max({size, std::abs(at_a), std::abs(at_b)});
    }
    const double reach = axis.norm() * ((b[0] - a[0]).norm() + edges_a[0].norm() + edges_b[0].norm());
    return std::max(low_b - high_a, low_a - high_b) > kShareOfRounding * std::max(size, reach);
  };
  const Vector3d normal_a = edges_a[0].cross(edges_a[1]);
  const Vector3d normal_b = edges_b[0].cross(edges_b[1]);
  if (separates(normal_a) || separates(normal_b))
    return true;
  for (const Vector3d& edge_a : edges_a)
  {
    for (const Vector3d& edge_b : edges_b)
      if (separates(edge_a.cross(edge_b)))
        return true;
    if (separates(normal_a.cross(edge_a)))
      return true;
  }
  for (const Vector3d& edge_b : edges_b)
    if (separates(normal_b.cross(edge_b)))
      return true;
  return false;
}

class Nesting
{
 public:
  Nesting(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles)
    : points_(points), triangles_(triangles)
  {
  }

  /// Whether it is proven that the surface of `inner` lies within the solid of `outer` and does not touch it.
  bool isIn(const Shell& inner, const Shell& outer)
  {
    return liesStrictlyIn(inner.box, outer.box) && spend(outer.triangles.size()) && areShellsApart(inner, outer) &&
           startsIn(inner, outer);
  }

  /// Counts steps. False if there are too many: then nothing is proven any more.
  bool spend(std::size_t steps) { return (steps_ += steps) <= kMostComparisons; }

 private:
  std::array<Vector3d, 3> cornersOf(std::uint32_t t) const
  {
    return {points_[triangles_[t][0]], points_[triangles_[t][1]], points_[triangles_[t][2]]};
  }

  AlignedBox3d boxOf(std::uint32_t t) const
  {
    const std::array<Vector3d, 3> c = cornersOf(t);
    return AlignedBox3d(c[0]).extend(c[1]).extend(c[2]);
  }

  struct Boxed
  {
    AlignedBox3d box;
    std::uint32_t triangle;
  };

  /// The triangles that overlap a box, by their lowest x.
  std::vector<Boxed> near(const Shell& shell, const AlignedBox3d& box) const
  {
    std::vector<Boxed> found;
    for (const std::uint32_t t : shell.triangles)
      if (const AlignedBox3d own = boxOf(t); own.intersects(box))
        found.push_back({own, t});
    std::sort(found.begin(), found.end(),
              [](const Boxed& a, const Boxed& b) { return a.box.min().x() < b.box.min().x(); });
    return found;
  }

  bool areShellsApart(const Shell& a, const Shell& b)
  {
    const std::vector<Boxed> near_a = near(a, b.box);
    const std::vector<Boxed> near_b = near(b, a.box);
    // Each pair of overlapping boxes is found at the box that begins later.
    const auto meets = [this](const Boxed& first, const std::vector<Boxed>& others, bool or_equal)
    {
      const double begin = first.box.min().x();
      auto other = std::lower_bound(others.begin(), others.end(), begin,
                                    [](const Boxed& boxed, double x) { return boxed.box.min().x() < x; });
      for (; other != others.end() && other->box.min().x() <= first.box.max().x(); ++other)
      {
        if (!or_equal && other->box.min().x() == begin)
          continue;
        if (!spend(1))
          return true;
        if (first.box.intersects(other->box) && !areApart(cornersOf(first.triangle), cornersOf(other->triangle)))
          return true;
      }
      return false;
    };
    for (const Boxed& boxed : near_a)
      if (meets(boxed, near_b, true))
        return false;
    for (const Boxed& boxed : near_b)
      if (meets(boxed, near_a, false))
        return false;
    return true;
  }

  /// Whether a point of `inner` has a winding number of `outer` that is not 0.
  bool startsIn(const Shell& inner, const Shell& outer)
  {
    const std::array<Vector3d, 3> directions = {
        {{1.0, 0.0137, -0.0291}, {-0.0173, 1.0, 0.0219}, {0.0311, -0.0157, 1.0}}};
    std::vector<Corners> triangles;
    for (const std::uint32_t t : outer.triangles)
      triangles.push_back(triangles_[t]);
    constexpr std::size_t kMostRays = 12;
    for (std::size_t ray = 0; ray < kMostRays; ++ray)
    {
      const std::array<Vector3d, 3> c = cornersOf(inner.triangles[ray * inner.triangles.size() / kMostRays]);
      const Vector3d start = 0.2718281828 * c[0] + 0.3141592654 * c[1] + 0.4140125318 * c[2];
      if (!spend(outer.triangles.size()))
        return false;
      if (const std::optional<int> winding = windingNumber({start, directions[ray % 3]}, points_, triangles))
        return *winding != 0;
    }
    return false;
  }

  const std::vector<Vector3d>& points_;
  const std::vector<Corners>& triangles_;
  std::size_t steps_ = 0;
};

/// Triangles that share an edge alone belong to one shell. At an edge of more triangles, those shells of a cycle are
/// joined that do not run along it equally often in both directions.
std::vector<Shell> shellsOf(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles,
                            const std::vector<EdgeUse>& uses, const std::vector<std::uint32_t>& cycles)
{
  DisjointSets sets = patchSets(uses, triangles.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joined;
  struct Share
  {
    std::uint32_t cycle;
    std::uint32_t set;
    int direction;
  };
  std::vector<Share> shares;
  visitEdges(uses,
             [&](auto first, auto last)
             {
               if (last - first == 2)
                 return;
               shares.clear();
               for (auto use = first; use != last; ++use)
                 shares.push_back({cycles[use->triangle], sets.find(use->triangle), use->upwards ? 1 : -1});
               std::sort(shares.begin(), shares.end(),
                         [](const Share& a, const Share& b)
                         { return std::pair(a.cycle, a.set) < std::pair(b.cycle, b.set); });
               std::optional<Share> open;
               for (auto begin = shares.begin(); begin != shares.end();)
               {
                 int sum = 0;
                 auto end = begin;
                 for (; end != shares.end() && end->set == begin->set; ++end)
                   sum += end->direction;
                 if (sum != 0 && open && open->cycle == begin->cycle)
                   joined.emplace_back(open->set, begin->set);
                 if (sum != 0)
                   open = *begin;
                 begin = end;
               }
             });
  for (const auto& [a, b] : joined)
    sets.unite(a, b);
  std::vector<bool> used(triangles.size(), false);
  for (const EdgeUse& use : uses)
    used[use.triangle] = true;
  std::vector<Shell> shells;
  std::vector<std::uint32_t> shell_of_set(triangles.size(), ~0U);
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
  {
    if (!used[t])
      continue;
    std::uint32_t& number = shell_of_set[sets.find(t)];
    if (number == ~0U)
    {
      number = static_cast<std::uint32_t>(shells.size());
      shells.emplace_back();
    }
    Shell& shell = shells[number];
    shell.triangles.push_back(t);
    const Vector3d& origin = points[triangles[shell.triangles.front()][0]];
    const Vector3d a = points[triangles[t][0]] - origin;
    const Vector3d b = points[triangles[t][1]] - origin;
    const Vector3d c = points[triangles[t][2]] - origin;
    shell.volume += a.dot(b.cross(c)) / 6.0;
    for (const std::uint32_t corner : triangles[t])
      shell.box.extend(points[corner]);
  }
  return shells;
}
}  // namespace

std::vector<std::uint32_t> trianglesToTurn(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles,
                                           const std::vector<EdgeUse>& uses, const std::vector<std::uint32_t>& cycles)
{
  std::vector<Shell> shells = shellsOf(points, triangles, uses, cycles);
  const auto is_negative = [](const Shell& shell) { return shell.volume < 0.0; };
  const auto negative = std::count_if(shells.begin(), shells.end(), is_negative);
  if (negative == 0 || negative == static_cast<std::ptrdiff_t>(shells.size()))
    return {};
  std::stable_sort(shells.begin(), shells.end(),
                   [](const Shell& a, const Shell& b) { return a.squaredDiagonal() > b.squaredDiagonal(); });
  Nesting nesting(points, triangles);
  for (auto shell = shells.begin(); shell != shells.end(); ++shell)
  {
    std::vector<const Shell*> around;
    bool all_same = true;
    for (auto other = shell; other-- != shells.begin() && nesting.spend(1);)
      if (liesStrictlyIn(shell->box, other->box))
      {
        around.push_back(&*other);
        all_same = all_same && is_negative(*other) == is_negative(*shell);
      }
    const Shell* parent = nullptr;
    for (auto other = around.begin(); !all_same && !parent && other != around.end(); ++other)
      parent = nesting.isIn(*shell, **other) ? *other : nullptr;
    const bool is_cavity = parent && parent->winding > 0 && is_negative(*parent) != is_negative(*shell);
    shell->winding = (parent ? parent->winding : 0) + (is_cavity ? -1 : 1);
    shell->turned = is_negative(*shell) != is_cavity;
  }
  std::vector<std::uint32_t> turned;
  if (!std::all_of(shells.begin(), shells.end(), [](const Shell& shell) { return shell.turned; }))
    for (const Shell& shell : shells)
      if (shell.turned)
        turned.insert(turned.end(), shell.triangles.begin(), shell.triangles.end());
  return turned;
}
}  // namespace gpu_planning_scene::core
