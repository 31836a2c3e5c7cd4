#include "model/solids/outer_shell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include <Eigen/Geometry>

#include "model/solids/orientation.h"

// Around an edge, the triangles are sorted by angle. The space between two neighbours joins the side of the one that
// faces the other. The sets of joined sides are the boundaries of the chambers and of the outside (Q. Zhou, E.
// Grinspun, D. Zorin, A. Jacobson: Mesh arrangements for solid geometry. ACM Transactions on Graphics 35(4), 2016). A
// ray that leaves the surface finds a side that faces the outside.
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

/// Rays begin at so many triangles of a piece.
constexpr std::size_t kMostOrigins = 64;
/// A ray that meets a triangle this near to its border, as a share of its area, is not used.
constexpr double kNearBorder = 1e-6;

/// The number of a side of a triangle. The front is the side from which its corners run counter-clockwise.
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

  bool areJoined(std::uint32_t a, std::uint32_t b) { return joined_.find(a) == joined_.find(b); }

  /// The triangles of each set that edges connect.
  std::vector<std::vector<std::uint32_t>> pieces()
  {
    std::vector<std::vector<std::uint32_t>> result;
    std::vector<std::size_t> number(triangles_.size(), triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    {
      std::size_t& piece = number[pieces_.find(t)];
      if (piece == triangles_.size())
      {
        piece = result.size();
        result.emplace_back();
      }
      result[piece].push_back(t);
    }
    return result;
  }

  /// Sides of the piece that face the outside, found by rays from the largest triangle of each set of joined sides. Of
  /// two sheets that lie upon one another, the outer one can be taken for the inner one. Then the outside is more than
  /// one set.
  std::vector<std::uint32_t> outside(const std::vector<std::uint32_t>& piece)
  {
    std::map<std::uint32_t, std::uint32_t> largest;  // triangle of each set
    for (const std::uint32_t t : piece)
      for (const std::uint32_t side : {front(t), back(t)})
        if (std::uint32_t& known = largest.try_emplace(joined_.find(side), t).first->second;
            normal(t).squaredNorm() > normal(known).squaredNorm())
          known = t;
    std::set<std::uint32_t> origins;
    for (const auto& [unused, triangle] : largest)
      if (origins.size() < kMostOrigins)
        origins.insert(triangle);
    // Directions off the normal, because opposite triangles often lie exactly opposite each other.
    const Vector3d tilts[] = {{0.0123, 0.0371, 0.0237}, {-0.0531, 0.0113, 0.0319}};
    std::vector<std::uint32_t> sides;
    for (const std::uint32_t triangle : origins)
      for (const Vector3d& tilt : tilts)
        for (const double sign : {1.0, -1.0})
        {
          const Corners& t = triangles_[triangle];
          const Vector3d origin = 0.31 * points_[t[0]] + 0.36 * points_[t[1]] + 0.33 * points_[t[2]];
          const Vector3d direction = sign * (normal(triangle).normalized() + tilt);
          if (const std::optional<std::uint32_t> side = lastSide(piece, origin, direction))
            sides.push_back(*side);
        }
    return sides;
  }

 private:
  std::uint32_t patchOf(const Leaf& leaf) { return patches_.find(leaf.use.triangle); }

  Vector3d normal(std::uint32_t triangle) const
  {
    const Corners& t = triangles_[triangle];
    return (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]);
  }

  /// Sorts the triangles at an edge by angle. Of triangles that lie upon one another, the others are always on
  /// the same side of the one of the first patch, so that no chamber opens between two such sheets. Returns false if a
  /// triangle has no angle, because its corners lie on a line.
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

  /// The side at which a ray leaves the piece for the last time; empty if it meets a triangle near its border.
  std::optional<std::uint32_t> lastSide(const std::vector<std::uint32_t>& piece, const Vector3d& origin,
                                        const Vector3d& direction) const
  {
    std::optional<std::uint32_t> side;
    double last = -std::numeric_limits<double>::infinity();
    double next_to_last = last;
    for (const std::uint32_t number : piece)
    {
      const Corners& t = triangles_[number];
      const Vector3d a = points_[t[0]] - origin;
      const Vector3d b = points_[t[1]] - origin;
      const Vector3d c = points_[t[2]] - origin;
      const double weights[] = {direction.dot(b.cross(c)), direction.dot(c.cross(a)), direction.dot(a.cross(b))};
      const double sum = weights[0] + weights[1] + weights[2];
      const double border = kNearBorder * (std::abs(weights[0]) + std::abs(weights[1]) + std::abs(weights[2]));
      const double sign = sum < 0.0 ? -1.0 : 1.0;
      const double least = std::min({sign * weights[0], sign * weights[1], sign * weights[2]});
      if (least < -border)
        continue;
      if (!(least > border))
        return std::nullopt;
      const double distance = (weights[0] * a + weights[1] * b + weights[2] * c).dot(direction) / sum;
      next_to_last = std::max(next_to_last, std::min(last, distance));
      if (distance <= last)
        continue;
      last = distance;
      side = sum > 0.0 ? front(number) : back(number);
    }
    const bool is_sure = side && last - next_to_last > kNearBorder * std::max(std::abs(last), std::abs(next_to_last));
    return is_sure ? side : std::nullopt;
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
    const std::vector<std::uint32_t> outside = sides.outside(piece);
    if (outside.empty())
      continue;
    const auto is_outside = [&](std::uint32_t side)
    {
      return std::any_of(outside.begin(), outside.end(),
                         [&](std::uint32_t other) { return sides.areJoined(side, other); });
    };
    for (const std::uint32_t t : piece)
    {
      const bool is_front = is_outside(front(t));
      const bool is_back = is_outside(back(t));
      shell.places[t] = is_front && is_back   ? ShellPlace::Beside
                        : is_front || is_back ? ShellPlace::Shell
                                              : ShellPlace::Wall;
      shell.turned[t] = (is_back && !is_front) != (oriented[t] != triangles[t]);
    }
  }
  return shell;
}

}  // namespace gpu_planning_scene::core
