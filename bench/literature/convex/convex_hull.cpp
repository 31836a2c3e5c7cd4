#include "literature/convex/convex_hull.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

// Quickhull (Barber, Dobkin, Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", 1996): the point that is farthest
// outside of a facet replaces all facets that it sees by facets to the border of what it sees. The hull of points in a
// plane is Andrew's monotone chain (1979).
namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

class Quickhull
{
 public:
  Quickhull(const Points& points, double tolerance) : points_(points), tolerance_(tolerance) {}

  /// `first`: four corners of a tetrahedron with a volume. False if rounding errors stop the algorithm.
  bool run(const std::array<std::uint32_t, 4>& first)
  {
    if (!start(first))
      return false;
    for (std::size_t i = 0; i < faces_.size(); ++i)
      while (faces_[i].alive && !faces_[i].outside.empty())
        if (!addFarthest(i))
          return false;
    return true;
  }

  std::vector<HullFacet> facets() const
  {
    std::vector<HullFacet> facets;
    for (const Face& face : faces_)
      if (face.alive)
        facets.push_back(face.facet);
    return facets;
  }

 private:
  struct Face
  {
    HullFacet facet;
    std::array<std::size_t, 3> neighbors = {};  // neighbour i lies across the edge from corner i to corner i + 1
    std::vector<std::uint32_t> outside = {};
    bool alive = true;
  };

  double height(const Face& face, std::uint32_t point) const
  {
    return face.facet.normal.dot(points_[point]) - face.facet.offset;
  }

  std::optional<Face> faceOf(std::uint32_t a, std::uint32_t b, std::uint32_t c) const
  {
    const Vector3d normal = (points_[b] - points_[a]).cross(points_[c] - points_[a]);
    const double length = normal.norm();
    if (!(length > 0.0))
      return {};
    const Vector3d unit = normal / length;
    return Face{{{a, b, c}, unit, unit.dot(points_[a])}};
  }

  bool start(std::array<std::uint32_t, 4> t)
  {
    const auto base = faceOf(t[0], t[1], t[2]);
    if (!base)
      return false;
    if (height(*base, t[3]) > 0.0)
      std::swap(t[1], t[2]);
    const std::array<std::array<std::uint32_t, 3>, 4> corners{
        {{t[0], t[1], t[2]}, {t[0], t[3], t[1]}, {t[1], t[3], t[2]}, {t[2], t[3], t[0]}}};
    for (const auto& c : corners)
    {
      const auto face = faceOf(c[0], c[1], c[2]);
      if (!face)
        return false;
      faces_.push_back(*face);
    }
    faces_[0].neighbors = {1, 2, 3};
    faces_[1].neighbors = {3, 2, 0};
    faces_[2].neighbors = {1, 3, 0};
    faces_[3].neighbors = {2, 1, 0};
    std::vector<std::uint32_t> all(points_.size());
    std::iota(all.begin(), all.end(), 0U);
    assign(all, 0);
    return true;
  }

  /// Gives each point to a face, of the faces from `begin`, outside of which it lies.
  void assign(const std::vector<std::uint32_t>& points, std::size_t begin)
  {
    for (const std::uint32_t point : points)
      for (std::size_t i = begin; i < faces_.size(); ++i)
        if (height(faces_[i], point) > tolerance_)
        {
          faces_[i].outside.push_back(point);
          break;
        }
  }

  bool addFarthest(std::size_t from)
  {
    const std::vector<std::uint32_t>& outside = faces_[from].outside;
    const std::uint32_t point = *std::max_element(outside.begin(), outside.end(),
                                                  [&](std::uint32_t a, std::uint32_t b)
                                                  { return height(faces_[from], a) < height(faces_[from], b); });
    std::vector<std::size_t> seen{from};
    faces_[from].alive = false;
    struct Border
    {
      std::uint32_t begin;
      std::uint32_t end;
      std::size_t beyond;
    };
    std::vector<Border> border;
    std::vector<std::uint32_t> orphans;
    for (std::size_t i = 0; i < seen.size(); ++i)
    {
      const Face face = faces_[seen[i]];
      orphans.insert(orphans.end(), face.outside.begin(), face.outside.end());
      for (std::size_t k = 0; k < 3; ++k)
      {
        Face& other = faces_[face.neighbors[k]];
        if (!other.alive)
          continue;
        if (height(other, point) > tolerance_)
        {
          other.alive = false;
          seen.push_back(face.neighbors[k]);
        }
      }
    }
    for (const std::size_t i : seen)
      for (std::size_t k = 0; k < 3; ++k)
        if (faces_[faces_[i].neighbors[k]].alive)
          border.push_back({faces_[i].facet.corners[k], faces_[i].facet.corners[(k + 1) % 3], faces_[i].neighbors[k]});

    const std::size_t begin = faces_.size();
    std::map<std::uint32_t, std::size_t> face_from;  // by the first corner of its border
    for (const Border& edge : border)
    {
      auto face = faceOf(edge.begin, edge.end, point);
      if (!face || !face_from.emplace(edge.begin, faces_.size()).second)
        return false;
      face->neighbors[0] = edge.beyond;
      Face& beyond = faces_[edge.beyond];
      for (std::size_t k = 0; k < 3; ++k)
        if (beyond.facet.corners[k] == edge.end && beyond.facet.corners[(k + 1) % 3] == edge.begin)
          beyond.neighbors[k] = faces_.size();
      faces_.push_back(*face);
    }
    for (std::size_t i = begin; i < faces_.size(); ++i)
    {
      const auto next = face_from.find(faces_[i].facet.corners[1]);
      if (next == face_from.end())
        return false;
      faces_[i].neighbors[1] = next->second;
      faces_[next->second].neighbors[2] = i;
    }
    orphans.erase(std::remove(orphans.begin(), orphans.end(), point), orphans.end());
    assign(orphans, begin);
    for (const std::size_t i : seen)
      faces_[i].outside.clear();
    return true;
  }

  const Points& points_;
  double tolerance_;
  std::vector<Face> faces_;
};

template <class Measure>
std::uint32_t largest(const Points& points, const Measure& measure)
{
  std::size_t best = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (measure(points[i]) > measure(points[best]))
      best = i;
  return static_cast<std::uint32_t>(best);
}

/// The hull of points in the plane through `origin` with the given normal.
ConvexHull flatHull(const Points& points, const Vector3d& origin, const Vector3d& normal)
{
  const Vector3d x = normal.unitOrthogonal();
  const Vector3d y = normal.cross(x);
  struct Place
  {
    double x;
    double y;
    std::uint32_t point;
  };
  std::vector<Place> places;
  for (std::size_t i = 0; i < points.size(); ++i)
    places.push_back({x.dot(points[i] - origin), y.dot(points[i] - origin), static_cast<std::uint32_t>(i)});
  std::sort(
      places.begin(), places.end(),
      [](const Place& a, const Place& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  const auto turn = [](const Place& a, const Place& b, const Place& c)
  { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); };
  std::vector<Place> chain;
  const auto add = [&](const Place& place, std::size_t fixed)
  {
    while (chain.size() > fixed && turn(chain[chain.size() - 2], chain.back(), place) <= 0.0)
      chain.pop_back();
    chain.push_back(place);
  };
  for (const Place& place : places)
    add(place, 1);
  const std::size_t lower = chain.size();
  for (auto place = places.rbegin() + 1; place != places.rend(); ++place)
    add(*place, lower);
  chain.pop_back();
  ConvexHull hull;
  for (std::size_t i = 0; i < chain.size(); ++i)
  {
    hull.vertices.push_back(chain[i].point);
    hull.area += 0.5 * turn(chain[0], chain[i], chain[(i + 1) % chain.size()]);
  }
  return hull;
}

ConvexHull allPoints(const Points& points)
{
  ConvexHull hull;
  hull.vertices.resize(points.size());
  std::iota(hull.vertices.begin(), hull.vertices.end(), 0U);
  return hull;
}
}  // namespace

ConvexHull convexHull(const Points& points, double tolerance)
{
  if (points.size() < 4)
  {
    ConvexHull hull = allPoints(points);
    if (points.size() == 3)
      hull.area = 0.5 * (points[1] - points[0]).cross(points[2] - points[0]).norm();
    return hull;
  }
  const std::uint32_t a = largest(
      points, [&](const Vector3d& p) { return (p - points[0]).squaredNorm(); });
  const std::uint32_t b = largest(points, [&](const Vector3d& p) { return (p - points[a]).squaredNorm(); });
  const Vector3d line = (points[b] - points[a]).normalized();
  const std::uint32_t c = largest(points, [&](const Vector3d& p) { return line.cross(p - points[a]).squaredNorm(); });
  const Vector3d normal = line.cross(points[c] - points[a]);
  if (normal.norm() <= tolerance)
    return allPoints(points);
  const Vector3d unit = normal.normalized();
  const std::uint32_t d = largest(points, [&](const Vector3d& p) { return std::abs(unit.dot(p - points[a])); });
  if (std::abs(unit.dot(points[d] - points[a])) <= tolerance)
    return flatHull(points, points[a], unit);

  Quickhull quickhull(points, tolerance);
  if (!quickhull.run({a, b, c, d}))
    return allPoints(points);
  ConvexHull hull;
  hull.facets = quickhull.facets();
  for (const HullFacet& facet : hull.facets)
    hull.vertices.insert(hull.vertices.end(), facet.corners.begin(), facet.corners.end());
  std::sort(hull.vertices.begin(), hull.vertices.end());
  hull.vertices.erase(std::unique(hull.vertices.begin(), hull.vertices.end()), hull.vertices.end());
  return hull;
}
}  // namespace gpu_planning_scene::core::literature
