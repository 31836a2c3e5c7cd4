// Polygons of mesh files as triangles. The independent implementation is the winding number of the outline at a point.

#include <map>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "model/meshes/orientation.h"
#include "model/meshes/triangulate_polygon.h"
#include "model/model_testing.h"
#include "support/repetitions.h"

namespace gpu_planning_scene::core
{
namespace
{
using Point = Eigen::Vector2d;
using Outline = std::vector<Point>;
using CutTriangles = std::vector<std::array<std::uint32_t, 3>>;

double cross(const Point& a, const Point& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

/// The winding number of a closed line around a point that is not on it.
int winding(const Outline& outline, const Point& p)
{
  int number = 0;
  for (std::size_t i = 0; i < outline.size(); ++i)
  {
    const Point& a = outline[i];
    const Point& b = outline[(i + 1) % outline.size()];
    const bool left = cross(b - a, p - a) > 0.0;
    if (a.y() <= p.y() && b.y() > p.y() && left)
      ++number;
    if (a.y() > p.y() && b.y() <= p.y() && !left)
      --number;
  }
  return number;
}

/// An outline and holes, in a plane of space. The plane is parallel to no axis, so that no coordinate is constant.
struct Polygon
{
  std::vector<Outline> loops;

  int windingAt(const Point& p) const
  {
    return std::accumulate(
        loops.begin(), loops.end(), 0, [&](int sum, const Outline& loop) { return sum + winding(loop, p); });
  }
  Outline corners() const
  {
    Outline all;
    for (const Outline& loop : loops)
      all.insert(all.end(), loop.begin(), loop.end());
    return all;
  }
  std::vector<std::uint32_t> holeStarts() const
  {
    std::vector<std::uint32_t> starts;
    std::size_t start = 0;
    for (std::size_t i = 0; i + 1 < loops.size(); ++i)
      starts.push_back(static_cast<std::uint32_t>(start += loops[i].size()));
    return starts;
  }
};

enum class Plane
{
  Floor,    // z is 0
  Ceiling,  // turned over
  Tilted    // coordinates remain exact
};

CutTriangles triangulated(const Polygon& polygon, Plane plane)
{
  std::vector<Eigen::Vector3d> corners;
  for (const Point& p : polygon.corners())
    if (plane == Plane::Floor)
      corners.emplace_back(p.x(), p.y(), 0.0);
    else if (plane == Plane::Ceiling)
      corners.emplace_back(p.x(), -p.y(), 3.0);
    else
      corners.emplace_back(p.y() + 0.5 * p.x(), p.x(), p.y());
  return triangulatePolygon(corners, polygon.holeStarts());
}

int countAt(const CutTriangles& triangles, const Outline& corners, const Point& p)
{
  return static_cast<int>(std::count_if(
      triangles.begin(), triangles.end(),
      [&](const auto& triangle) {
        return winding({corners[triangle[0]], corners[triangle[1]], corners[triangle[2]]}, p) != 0;
      }));
}

/// Each edge of the polygon, in its direction, is an edge of one triangle; each other edge of a triangle has a
/// neighbour. `holes_turn`: the holes may be given in both directions.
void expectTheEdgesOfThePolygon(const CutTriangles& triangles, const Polygon& polygon)
{
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& triangle : triangles)
    for (std::size_t i = 0; i < 3; ++i)
    {
      const std::uint32_t a = triangle[i];
      const std::uint32_t b = triangle[(i + 1) % 3];
      a < b ? ++edges[{a, b}] : --edges[{b, a}];
    }
  std::set<std::pair<std::uint32_t, std::uint32_t>> open;
  for (const auto& [edge, sum] : edges)
    if (sum != 0)
    {
      EXPECT_EQ(std::abs(sum), 1);
      open.insert(edge);
    }
  std::set<std::pair<std::uint32_t, std::uint32_t>> expected;
  std::uint32_t first = 0;
  for (const Outline& loop : polygon.loops)
  {
    const auto size = static_cast<std::uint32_t>(loop.size());
    for (std::uint32_t i = 0; i < size; ++i)
      expected.insert(std::minmax({first + i, first + (i + 1) % size}));
    first += size;
  }
  EXPECT_EQ(open, expected);
}

void expectExactCover(const Polygon& polygon, Plane plane, std::mt19937& random)
{
  const Outline corners = polygon.corners();
  const CutTriangles triangles = triangulated(polygon, plane);
  EXPECT_EQ(triangles.size(), corners.size() + 2 * polygon.loops.size() - 4);
  expectTheEdgesOfThePolygon(triangles, polygon);
  double area = 0.0;
  for (const auto& [a, b, c] : triangles)
  {
    const double twice = cross(corners[b] - corners[a], corners[c] - corners[a]);
    EXPECT_GT(twice, 0.0) << "a triangle without an area, or turned over";
    area += 0.5 * twice;
  }
  double expected = 0.0;
  for (const Outline& loop : polygon.loops)
    for (std::size_t i = 0; i < loop.size(); ++i)
      expected += 0.5 * cross(loop[i], loop[(i + 1) % loop.size()]);
  EXPECT_NEAR(area, expected, 1e-9 * (1.0 + std::abs(expected)));
  Point lower = corners.front();
  Point upper = corners.front();
  for (const Point& p : corners)
  {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  std::uniform_real_distribution<double> share(-0.1, 1.1);
  for (int i = 0; i < 50; ++i)
  {
    const Point p = lower + Point(share(random), share(random)).cwiseProduct(upper - lower);
    EXPECT_EQ(countAt(triangles, corners, p), polygon.windingAt(p)) << "at " << p.transpose();
  }
}

/// Corners around the origin with random radii. Some are on a line, or in a row at one place of a grid.
Outline star(std::mt19937& random)
{
  const int count = std::uniform_int_distribution<int>(3, 40)(random);
  std::uniform_real_distribution<double> radius(0.05, 1.0);
  Outline outline;
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2.0 * std::acos(-1.0) * (i + 0.3) / count;
    const double r = radius(random);
    outline.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  return outline;
}

/// The boundary of random cells of a grid that hang together by edges, and touch nowhere else by a corner. Each cell
/// gives its corners, so many corners lie on a line.
Polygon cells(std::mt19937& random)
{
  constexpr int kSize = 7;
  std::array<std::array<bool, kSize + 2>, kSize + 2> full{};
  const auto touches_by_corner = [&](int x, int y)
  {
    for (const int dx : {-1, 1})
      for (const int dy : {-1, 1})
        if (full[x + dx][y + dy] && !full[x + dx][y] && !full[x][y + dy])
          return true;
    return false;
  };
  full[4][4] = true;
  std::uniform_int_distribution<int> place(1, kSize);
  for (int i = 0; i < 300; ++i)
  {
    const int x = place(random);
    const int y = place(random);
    if ((full[x - 1][y] || full[x + 1][y] || full[x][y - 1] || full[x][y + 1]) && !touches_by_corner(x, y))
      full[x][y] = true;
  }
  const auto is_surrounded = [&](int x, int y)
  {
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        if (!full[x + dx][y + dy])
          return false;
    return true;
  };
  for (int i = 0; i < 30; ++i)
  {
    const int x = place(random);
    const int y = place(random);
    full[x][y] = full[x][y] && !is_surrounded(x, y);
  }
  std::map<std::pair<int, int>, std::pair<int, int>> next;  // along the boundary, with cells on the left
  for (int x = 1; x <= kSize; ++x)
    for (int y = 1; y <= kSize; ++y)
      if (full[x][y])
      {
        if (!full[x][y - 1])
          next[{x, y}] = {x + 1, y};
        if (!full[x + 1][y])
          next[{x + 1, y}] = {x + 1, y + 1};
        if (!full[x][y + 1])
          next[{x + 1, y + 1}] = {x, y + 1};
        if (!full[x - 1][y])
          next[{x, y + 1}] = {x, y};
      }
  Polygon polygon;
  while (!next.empty())
  {
    Outline loop;
    for (auto at = next.begin(); at != next.end();)
    {
      loop.emplace_back(at->first.first, at->first.second);
      const auto to = at->second;
      next.erase(at);
      at = next.find(to);
    }
    polygon.loops.push_back(loop);  // the first loop has the lowest x, so it is the outline
  }
  return polygon;
}

TEST(Polygon, ConcaveOutlinesAreCoveredExactly)
{
  for (int seed = 0; seed < repetitions(30, 10000); ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(static_cast<unsigned>(seed));
    const Polygon polygon{{star(random)}};
    for (const Plane plane : {Plane::Floor, Plane::Ceiling, Plane::Tilted})
      expectExactCover(polygon, plane, random);
  }
}

TEST(Polygon, HolesAndCornersOnALineAreCoveredExactly)
{
  std::size_t holes = 0;
  for (int seed = 0; seed < repetitions(30, 10000); ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(static_cast<unsigned>(seed));
    const Polygon polygon = cells(random);
    holes += polygon.loops.size() - 1;
    for (const Plane plane : {Plane::Floor, Plane::Ceiling, Plane::Tilted})
      expectExactCover(polygon, plane, random);
  }
  EXPECT_GT(holes, 20u) << "too few holes for a test";
}

TEST(Polygon, AHoleCanTurnEitherWay)
{
  const Outline square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  Outline hole{{1, 1}, {1, 3}, {3, 3}, {3, 1}};
  for (int i = 0; i < 2; ++i, std::reverse(hole.begin(), hole.end()))
  {
    const Polygon polygon{{square, hole}};
    const CutTriangles triangles = triangulated(polygon, Plane::Floor);
    EXPECT_EQ(countAt(triangles, polygon.corners(), {2.1, 2.2}), 0);
    EXPECT_EQ(countAt(triangles, polygon.corners(), {0.5, 2.2}), 1);
  }
}

TEST(Polygon, AHoleMayTouchTheOutlineInACorner)
{
  const Polygon polygon{{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{0, 0}, {3, 3.5}, {3.5, 3}}}};
  const CutTriangles triangles = triangulated(polygon, Plane::Floor);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0.0, 4.0);
  for (int i = 0; i < 200; ++i)
  {
    const Point p(place(random), place(random));
    EXPECT_EQ(countAt(triangles, polygon.corners(), p), polygon.windingAt(p)) << "at " << p.transpose();
  }
}

TEST(Polygon, AHoleThatIsNotInsideTheOutlineIsRefused)
{
  const Outline square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  for (const double x : {-2.0, 3.0, 9.0})
  {
    const Polygon polygon{{square, {{x, 1}, {x, 3}, {x + 2, 3}, {x + 2, 1}}}};
    EXPECT_NE(errorOf([&] { triangulated(polygon, Plane::Floor); }).find("hole"), std::string::npos) << x;
  }
}

TEST(Polygon, OutlinesThatCrossThemselvesLoseNothing)
{
  for (int seed = 0; seed < repetitions(100, 20000); ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(static_cast<unsigned>(seed));
    const int count = std::uniform_int_distribution<int>(4, 15)(random);
    std::uniform_int_distribution<int> place(0, seed % 2 == 0 ? 4 : 1000);  // on a coarse grid, corners coincide
    Polygon polygon{{{}}};
    for (int i = 0; i < count; ++i)
      polygon.loops[0].emplace_back(place(random), place(random));
    const CutTriangles triangles = triangulated(polygon, Plane::Floor);
    std::uniform_real_distribution<double> share(0.0, seed % 2 == 0 ? 4.0 : 1000.0);
    for (int i = 0; i < 100; ++i)
    {
      const Point p(share(random), share(random));
      if (winding(polygon.loops[0], p) != 0)
        EXPECT_GT(countAt(triangles, polygon.loops[0], p), 0) << "at " << p.transpose();
    }
  }
}

TEST(Polygon, RepeatedCornersCountOnce)
{
  const Polygon polygon{{{{0, 0}, {0, 0}, {2, 0}, {2, 2}, {2, 2}, {2, 2}, {0, 2}, {0, 0}}}};
  EXPECT_EQ(triangulated(polygon, Plane::Floor).size(), 2u);
}

TEST(Polygon, AnOutlineWithoutAnAreaRemains)
{
  const Polygon line{{{{0, 0}, {2, 0}, {1, 0}, {3, 0}}}};
  EXPECT_EQ(triangulated(line, Plane::Floor).size(), 2u);
  const Polygon point{{{{1, 1}, {1, 1}, {1, 1}, {1, 1}}}};
  EXPECT_EQ(triangulated(point, Plane::Floor).size(), 2u);
}

TEST(Polygon, ManyCornersTakeMilliseconds)
{
  Outline gear;
  for (int i = 0; i < 4000; ++i)
  {
    const double angle = 2.0 * std::acos(-1.0) * i / 4000;
    gear.emplace_back((i % 2 == 0 ? 1.0 : 0.9) * std::cos(angle), (i % 2 == 0 ? 1.0 : 0.9) * std::sin(angle));
  }
  EXPECT_EQ(triangulated({{gear}}, Plane::Tilted).size(), gear.size() - 2);
}

TEST(Orientation, IsExactWhereDoublesRound)
{
  // Corners a few units in the last place beside a diagonal. Integers of 128 bits are the independent implementation.
  std::mt19937 random(1);
  std::uniform_int_distribution<long long> large(1LL << 51, 1LL << 52);
  std::uniform_int_distribution<long long> few(-3, 3);
  int on_line = 0;
  for (int i = 0; i < 100000; ++i)
  {
    const long long x = large(random);
    const long long m = large(random) / 2;
    const std::array<std::array<long long, 2>, 3> p{
        {{x + few(random), x + few(random)}, {x + m + few(random), x + m + few(random)}, {x / 2 + few(random), x / 2}}};
    const auto point = [&](int k) -> Point {
      return {std::ldexp(static_cast<double>(p[k][0]), -40), std::ldexp(static_cast<double>(p[k][1]), -40)};
    };
    __extension__ using Wide = __int128;
    const Wide sign = static_cast<Wide>(p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                      static_cast<Wide>(p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    EXPECT_EQ(orientation(point(0), point(1), point(2)), sign > 0 ? 1 : (sign < 0 ? -1 : 0)) << i;
    on_line += sign == 0 ? 1 : 0;
  }
  EXPECT_GT(on_line, 100);
}
}  // namespace
}  // namespace gpu_planning_scene::core
