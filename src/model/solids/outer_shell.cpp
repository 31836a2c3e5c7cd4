#include "model/solids/outer_shell.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "model/solids/largest_triangles.h"
#include "model/solids/line_crossing.h"
#include "model/solids/orientation.h"

// Around an edge, the triangles are sorted by angle. The space between two neighbours joins the side of the one that
// faces the other. The sets of joined sides are the boundaries of the chambers and of the outside (Q. Zhou, E.
// Grinspun, D. Zorin, A. Jacobson: Mesh arrangements for solid geometry. ACM Transactions on Graphics 35(4), 2016). A
// line through the surface begins and ends outside.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// Triangles with a common edge lie upon one another if their angle is at most this, in radians.
constexpr double kSameAngle = 1e-6;

/// Three corners lie on a line if the distance of the third one from the edge is at most this share of its distance
/// from an end of the edge.
constexpr double kOnLine = 1e-9;

/// Lines go through so many triangles of a piece.
constexpr std::size_t kMostLines = 64;
/// Two triangles on a line are at one place if their distance is at most this share of their distance from its origin.
constexpr double kSamePlace = 1e-6;

/// The number of a side of a triangle; that of the other side differs in the last bit. The front is the side from which
/// its corners run counter-clockwise.
std::uint32_t front(std::uint32_t triangle)
{
  return 2 * triangle;
}
std::uint32_t back(std::uint32_t triangle)
{
  return 2 * triangle + 1;
}

/// A triangle at an edge.
struct Leaf
{
  double angle;  // about the edge, from its lower to its higher place
  EdgeUse use;
  Vector3d across;  // unit vector from the edge into the triangle

  /// The side towards larger angles.
  std::uint32_t next() const { return use.upwards ? front(use.triangle) : back(use.triangle); }
  std::uint32_t previous() const { return use.upwards ? back(use.triangle) : front(use.triangle); }
};

class Sides
{
 public:
  /// The triangles of a patch have the same direction.
  Sides(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles, SheetOrder order)
    : points_(points),
      triangles_(triangles),
      order_(order),
      uses_(edgeUses(triangles)),
      patches_(patchSets(uses_, triangles.size())),
      joined_(2 * triangles.size()),
      pieces_(triangles.size())
  {
    std::vector<Leaf> leaves;
    visitEdges(uses_,
               [&](auto first, auto last)
               {
                 for (auto use = first; use != last; ++use)
                   pieces_.unite(first->triangle, use->triangle);
                 const bool are_sorted = sortAround(&*first, static_cast<std::size_t>(last - first), leaves);
                 for (std::size_t i = 0; i < leaves.size(); ++i)
                 {
                   joined_.unite(leaves[i].next(), leaves[(i + 1) % leaves.size()].previous());
                   if (!are_sorted)
                     joined_.unite(leaves[i].next(), leaves[i].previous());
                 }
               });
  }

  /// The number of the set of joined sides to which a side belongs.
  std::uint32_t setOf(std::uint32_t side) { return joined_.find(side); }

  /// The triangles of each set that edges connect.
  std::vector<std::vector<std::uint32_t>> pieces() { return pieces_.sets(); }

  /// The sets of sides of a piece that face the outside, found by lines through the largest triangle of each set. There
  /// is more than one such set if two sheets lie upon one another and the outer one was taken for the inner one.
  std::set<std::uint32_t> outside(const std::vector<std::uint32_t>& piece)
  {
    // Off the normal, because opposite triangles often lie exactly opposite each other.
    const Vector3d tilts[] = {{0.0123, 0.0371, 0.0237}, {-0.0531, 0.0113, 0.0319}};
    std::set<std::uint32_t> sets;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> members;
    for (const std::uint32_t t : piece)
      for (const std::uint32_t side : {front(t), back(t)})
        members.emplace_back(setOf(side), t);
    for (const std::uint32_t triangle : largestOfSets(points_, triangles_, members, kMostLines))
      for (const Vector3d& tilt : tilts)
      {
        const Corners& t = triangles_[triangle];
        const Line line = {pointWithin(points_, t), areaNormal(points_, t).normalized() + tilt};
        for (const std::uint32_t side : sidesAtEnds(piece, line))
          sets.insert(setOf(side));
      }
    return sets;
  }

 private:
  std::uint32_t patchOf(const Leaf& leaf) { return patches_.find(leaf.use.triangle); }

  /// Sorts the triangles at an edge by angle. Triangles that lie upon one another are sorted by their patches, at each
  /// edge in the same order, so that no chamber opens between two such sheets. Returns false if a triangle has no
  /// angle, because its corners lie on a line.
  bool sortAround(const EdgeUse* uses, std::size_t count, std::vector<Leaf>& leaves)
  {
    leaves.clear();
    if (count <= 2)
    {
      for (std::size_t i = 0; i < count; ++i)
        leaves.push_back({0.0, uses[i], Vector3d::Zero()});
      return true;
    }
    const Vector3d& low = points_[uses->low];
    const Vector3d edge = (points_[uses->high] - low).normalized();
    bool are_sorted = true;
    for (std::size_t i = 0; i < count; ++i)
    {
      const Corners& t = triangles_[uses[i].triangle];
      const auto third = std::find_if(t.begin(), t.end(),
                                      [&](std::uint32_t place) { return place != uses->low && place != uses->high; });
      Vector3d across = points_[*third] - low;
      const double distance = across.norm();
      across -= edge.dot(across) * edge;
      are_sorted = are_sorted && across.norm() > kOnLine * distance;
      leaves.push_back({0.0, uses[i], across.normalized()});
    }
    const Vector3d x = leaves.front().across;
    const Vector3d y = edge.cross(x);
    for (Leaf& leaf : leaves)
    {
      leaf.angle = std::atan2(y.dot(leaf.across), x.dot(leaf.across));
      if (leaf.angle < -kSameAngle)
        leaf.angle += 2.0 * M_PI;
    }
    std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) { return a.angle < b.angle; });
    for (auto begin = leaves.begin(); begin != leaves.end();)
    {
      auto end = std::next(begin);
      while (end != leaves.end() && end->angle - std::prev(end)->angle <= kSameAngle)
        ++end;
      const auto first =
          std::min_element(begin, end, [this](const Leaf& a, const Leaf& b) { return patchOf(a) < patchOf(b); });
      const bool is_reversed = first->use.upwards != (order_ == SheetOrder::FirstBehind);
      std::sort(begin, end,
                [&](const Leaf& a, const Leaf& b)
                { return is_reversed ? patchOf(b) < patchOf(a) : patchOf(a) < patchOf(b); });
      begin = end;
    }
    return are_sorted;
  }

  /// The outer sides of the first and the last triangle on a line; none if the line passes near a border, and no side
  /// where two triangles are at one place.
  std::vector<std::uint32_t> sidesAtEnds(const std::vector<std::uint32_t>& piece, const Line& line) const
  {
    std::vector<std::pair<double, std::uint32_t>> ends;  // place on the line, and the side towards its end
    for (const std::uint32_t t : piece)
    {
      const LineCrossing met = crossing(line, points_, triangles_[t]);
      if (met.kind == LineCrossing::NearBorder)
        return {};
      if (met.kind == LineCrossing::Certain)
        ends.emplace_back(met.at, met.leaves_at_front ? front(t) : back(t));
    }
    std::sort(ends.begin(), ends.end());
    std::vector<std::uint32_t> sides;
    const auto are_apart = [](double a, double b) { return b - a > kSamePlace * std::max(std::abs(a), std::abs(b)); };
    if (ends.size() < 2)
      return sides;
    if (are_apart(ends[0].first, ends[1].first))
      sides.push_back(ends[0].second ^ 1U);  // the other side: the line comes from the outside
    if (are_apart(ends[ends.size() - 2].first, ends.back().first))
      sides.push_back(ends.back().second);
    return sides;
  }

  const std::vector<Vector3d>& points_;
  const std::vector<Corners>& triangles_;
  const SheetOrder order_;
  const std::vector<EdgeUse> uses_;
  DisjointSets patches_;
  DisjointSets joined_;  // sides with nothing between them
  DisjointSets pieces_;
};
}  // namespace

OuterShell outerShell(const std::vector<Vector3d>& points, const std::vector<Corners>& triangles, SheetOrder order)
{
  OuterShell shell{std::vector<ShellPlace>(triangles.size(), ShellPlace::Beside),
                   std::vector<bool>(triangles.size(), false)};
  const std::vector<Corners> oriented = orient(points, triangles).triangles;
  Sides sides(points, oriented, order);
  for (const std::vector<std::uint32_t>& piece : sides.pieces())
  {
    const std::set<std::uint32_t> outside = sides.outside(piece);
    for (const std::uint32_t t : piece)
    {
      const bool is_front = outside.count(sides.setOf(front(t))) != 0;
      const bool is_back = outside.count(sides.setOf(back(t))) != 0;
      shell.places[t] = outside.empty() || (is_front && is_back) ? ShellPlace::Beside
                        : is_front || is_back                    ? ShellPlace::Shell
                                                                 : ShellPlace::Wall;
      shell.turned[t] = (is_back && !is_front) != (oriented[t] != triangles[t]);
    }
  }
  return shell;
}
}  // namespace gpu_planning_scene::core
