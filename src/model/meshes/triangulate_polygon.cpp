#include "model/meshes/triangulate_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "model/meshes/orientation.h"
#include "model/meshes/polygon_holes.h"

// Ear clipping (G. H. Meisters: Polygons have ears, 1975) with exact orientations, in the projection along the axis
// that is nearest to the normal. This projection leaves out a coordinate and rounds nothing. Tessellators such as GLU's
// and Mapbox's earcut add vertices at crossings or leave out collinear ones. Then neighbouring polygons would no longer
// share their edges, and a closed mesh would leak.
namespace gpu_planning_scene::core
{
namespace
{
using Triangle = std::array<std::uint32_t, 3>;
using Points = std::vector<Eigen::Vector2d>;

/// The normal, with the length of twice the area (M. E. Newell). Coordinates relative to the first corner lose less.
Eigen::Vector3d normalOf(const std::vector<Eigen::Vector3d>& corners, std::size_t count)
{
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < count; ++i)
    normal += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  return normal;
}

/// Leaves out a coordinate, so that the outline turns counterclockwise.
Points projected(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& normal)
{
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  Eigen::Index x = (axis + 1) % 3;
  Eigen::Index y = (axis + 2) % 3;
  if (normal[axis] < 0.0)
    std::swap(x, y);
  Points points;
  points.reserve(corners.size());
  for (const Eigen::Vector3d& corner : corners)
    points.emplace_back(corner[x], corner[y]);
  return points;
}

/// The corners from `begin` to `end`, without those that equal their predecessor.
Loop loopOf(const std::vector<Eigen::Vector3d>& corners, std::size_t begin, std::size_t end)
{
  Loop loop;
  for (std::size_t i = begin; i < end; ++i)
    if (loop.empty() || corners[loop.back()] != corners[i])
      loop.push_back(static_cast<std::uint32_t>(i));
  while (loop.size() > 1 && corners[loop.front()] == corners[loop.back()])
    loop.pop_back();
  return loop;
}

double twiceTheArea(const Points& points, const Loop& loop)
{
  double area = 0.0;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i)
  {
    const Eigen::Vector2d a = points[loop[i]] - points[loop[0]];
    const Eigen::Vector2d b = points[loop[i + 1]] - points[loop[0]];
    area += a.x() * b.y() - a.y() * b.x();
  }
  return area;
}

/// Cuts ears off a loop of points until a triangle remains.
class EarClipper
{
 public:
  EarClipper(const Points& points, const Loop& loop)
    : points_(points), loop_(loop), next_(loop.size()), previous_(loop.size()), blocks_(loop.size())
  {
    const auto count = static_cast<std::uint32_t>(loop.size());
    for (std::uint32_t i = 0; i < count; ++i)
    {
      next_[i] = (i + 1) % count;
      previous_[i] = (i + count - 1) % count;
    }
    for (std::uint32_t i = 0; i < count; ++i)
      classify(i);
  }

  std::vector<Triangle> triangles()
  {
    std::uint32_t at = 1;  // a convex polygon becomes a fan around its first corner
    for (std::size_t left = loop_.size(); left > 3; --left)
    {
      const std::uint32_t ear = findEar(at, left);
      at = next_[ear];
      clip(ear);
    }
    add(at);
    return std::move(triangles_);
  }

 private:
  const Eigen::Vector2d& point(std::uint32_t corner) const { return points_[loop_[corner]]; }

  int turn(std::uint32_t corner) const
  {
    return orientation(point(previous_[corner]), point(corner), point(next_[corner]));
  }

  /// Only corners that are not convex can lie in an ear.
  void classify(std::uint32_t corner)
  {
    const bool blocks = turn(corner) <= 0;
    if (blocks && blocks_[corner] == 0)
      blockers_.push_back(corner);
    blocks_[corner] = blocks ? 1 : 0;
  }

  std::uint32_t findEar(std::uint32_t at, std::size_t left)
  {
    blockers_.erase(
        std::remove_if(blockers_.begin(), blockers_.end(), [&](auto corner) { return blocks_[corner] == 0; }),
        blockers_.end());
    std::uint32_t smallest = at;
    double smallest_area = std::numeric_limits<double>::infinity();
    for (; left > 0; --left, at = next_[at])
    {
      if (isEar(at))
        return at;
      const Eigen::Vector2d a = point(at) - point(previous_[at]);
      const Eigen::Vector2d b = point(next_[at]) - point(previous_[at]);
      const double area = std::abs(a.x() * b.y() - a.y() * b.x());
      if (area < smallest_area)
      {
        smallest = at;
        smallest_area = area;
      }
    }
    return smallest;  // the loop touches or crosses itself; each cut keeps the sum of the winding numbers
  }

  bool isEar(std::uint32_t corner) const
  {
    if (blocks_[corner] != 0)
      return false;
    const std::uint32_t before = previous_[corner];
    const std::uint32_t after = next_[corner];
    const Eigen::Vector2d& a = point(before);
    const Eigen::Vector2d& b = point(corner);
    const Eigen::Vector2d& c = point(after);
    const Eigen::Array2d lower = a.cwiseMin(b).cwiseMin(c);
    const Eigen::Array2d upper = a.cwiseMax(b).cwiseMax(c);
    for (const std::uint32_t blocker : blockers_)
    {
      const Eigen::Vector2d& p = point(blocker);
      if (blocker == before || blocker == after || (p.array() < lower).any() || (p.array() > upper).any())
        continue;
      const bool is_covered = p == a   ? entersAt(c, a, b, blocker)
                              : p == b ? entersAt(a, b, c, blocker)
                              : p == c ? entersAt(b, c, a, blocker)
                                       : isInside(a, b, c, p);
      if (is_covered)
        return false;
    }
    return true;
  }

  static bool isInside(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                       const Eigen::Vector2d& p)
  {
    return orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0;
  }

  /// Whether an edge of the blocker, which lies at the corner b of a triangle, begins inside the triangle.
  bool entersAt(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                std::uint32_t blocker) const
  {
    const std::uint32_t ends[] = {previous_[blocker], next_[blocker]};
    return std::any_of(std::begin(ends), std::end(ends),
                       [&](std::uint32_t end)
                       { return orientation(a, b, point(end)) > 0 && orientation(b, c, point(end)) > 0; });
  }

  void add(std::uint32_t corner)
  {
    triangles_.push_back({loop_[previous_[corner]], loop_[corner], loop_[next_[corner]]});
  }

  void clip(std::uint32_t corner)
  {
    add(corner);
    const std::uint32_t before = previous_[corner];
    const std::uint32_t after = next_[corner];
    next_[before] = after;
    previous_[after] = before;
    blocks_[corner] = 0;
    classify(before);
    classify(after);
  }

  const Points& points_;
  const Loop& loop_;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t> previous_;
  std::vector<char> blocks_;             // 1: the corner is not convex
  std::vector<std::uint32_t> blockers_;  // these corners, and some that have become convex
  std::vector<Triangle> triangles_;
};
}  // namespace

std::vector<Triangle> triangulatePolygon(const std::vector<Eigen::Vector3d>& corners,
                                         const std::vector<std::uint32_t>& hole_starts)
{
  const std::size_t outline_end = hole_starts.empty() ? corners.size() : hole_starts.front();
  const Eigen::Vector3d normal = normalOf(corners, outline_end);
  const Points points = projected(corners, normal);
  Loop outline = loopOf(corners, 0, outline_end);
  if (outline.size() < 3)  // a line or a point; it remains as a surface without an area
  {
    outline.resize(outline_end);
    std::iota(outline.begin(), outline.end(), 0U);
  }
  std::vector<Loop> holes;
  for (std::size_t i = 0; i < hole_starts.size(); ++i)
  {
    Loop hole = loopOf(corners, hole_starts[i], i + 1 < hole_starts.size() ? hole_starts[i + 1] : corners.size());
    if (twiceTheArea(points, hole) > 0.0)
      std::reverse(hole.begin(), hole.end());
    if (hole.size() >= 3)  // a smaller hole has no area
      holes.push_back(std::move(hole));
  }
  const Loop loop = joinHoles(points, std::move(outline), std::move(holes));
  return EarClipper(points, loop).triangles();
}
}  // namespace gpu_planning_scene::core
