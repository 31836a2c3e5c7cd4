#include "literature/convex/surface_patches.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "literature/convex/convex_hull.h"
#include "model/coordinate_hash.h"

// S. A. Ehmann, M. C. Lin: Accurate and fast proximity queries between polyhedra using convex surface decomposition,
// 2001. A patch grows over the neighbours of its triangles. It takes a triangle if all triangles of the patch then
// still lie on the hull of the patch. If the hull of the grown patch cuts another part of the mesh, the patch keeps
// only its first triangles, as many as bisection allows.
namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Vector3d;

constexpr double kFlatness = 1e-7;  // of the size of the mesh
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct Plane
{
  Vector3d normal;
  double offset;
};

class Decomposition
{
 public:
  explicit Decomposition(const Mesh& mesh) : mesh_(mesh)
  {
    Eigen::AlignedBox3d bounds;
    for (const Vector3d& vertex : mesh.vertices)
      bounds.extend(vertex);
    tolerance_ = kFlatness * bounds.diagonal().norm();
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    {
      Eigen::AlignedBox3d box;
      for (const std::uint32_t vertex : mesh.triangles[i])
        box.extend(mesh.vertices[vertex]);
      boxes_.push_back(box);
      widest_ = std::max(widest_, box.sizes().x());
    }
    by_x_.resize(mesh.triangles.size());
    std::iota(by_x_.begin(), by_x_.end(), 0U);
    std::sort(by_x_.begin(), by_x_.end(),
              [this](std::uint32_t a, std::uint32_t b) { return boxes_[a].min().x() < boxes_[b].min().x(); });
    findNeighbors();
  }

  std::vector<SurfacePatch> run()
  {
    std::vector<SurfacePatch> patches;
    patch_of_.assign(mesh_.triangles.size(), kNone);
    for (std::uint32_t seed = 0; seed < mesh_.triangles.size(); ++seed)
    {
      if (patch_of_[seed] != kNone)
        continue;
      const auto number = static_cast<std::uint32_t>(patches.size());
      SurfacePatch patch = grown(seed, number);
      if (!isClean(patch, patch.size()))
      {
        std::size_t good = 1;
        std::size_t bad = patch.size();
        while (bad - good > 1)
        {
          const std::size_t middle = (good + bad) / 2;
          (isClean(patch, middle) ? good : bad) = middle;
        }
        for (std::size_t i = good; i < patch.size(); ++i)
          patch_of_[patch[i]] = kNone;
        patch.resize(good);
      }
      patches.push_back(std::move(patch));
    }
    return patches;
  }

 private:
  /// The triangle across each edge. An edge that does not belong to exactly two triangles, in opposite directions, has
  /// none. Vertices at equal places count as one vertex.
  void findNeighbors()
  {
    std::unordered_map<Vector3d, std::uint32_t, CoordinateHash> places;
    std::vector<std::uint32_t> place_of;
    for (const Vector3d& vertex : mesh_.vertices)
      place_of.push_back(places.emplace(vertex, static_cast<std::uint32_t>(places.size())).first->second);
    struct Edge
    {
      std::uint32_t triangle;
      int side;
      int count;
    };
    const auto key = [](std::uint32_t from, std::uint32_t to)
    { return static_cast<std::uint64_t>(from) << 32U | static_cast<std::uint64_t>(to); };
    std::unordered_map<std::uint64_t, Edge> edges;
    const auto end_of = [&](std::uint32_t triangle, int side)
    { return place_of[mesh_.triangles[triangle][static_cast<std::size_t>(side % 3)]]; };
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i)
      for (int side = 0; side < 3; ++side)
        ++edges.emplace(key(end_of(i, side), end_of(i, side + 1)), Edge{i, side, 0}).first->second.count;
    neighbors_.assign(mesh_.triangles.size(), {kNone, kNone, kNone});
    for (const auto& [ends, edge] : edges)
    {
      const auto opposite = edges.find(key(static_cast<std::uint32_t>(ends), static_cast<std::uint32_t>(ends >> 32U)));
      if (edge.count == 1 && opposite != edges.end() && opposite->second.count == 1)
        neighbors_[edge.triangle][static_cast<std::size_t>(edge.side)] = opposite->second.triangle;
    }
  }

  const Vector3d& corner(std::uint32_t triangle, std::size_t i) const
  {
    return mesh_.vertices[mesh_.triangles[triangle][i]];
  }

  /// A triangle without area has a plane with the normal 0, on which all points lie.
  Plane planeOf(std::uint32_t triangle) const
  {
    const Vector3d normal =
        (corner(triangle, 1) - corner(triangle, 0)).cross(corner(triangle, 2) - corner(triangle, 0)).normalized();
    return {normal, normal.dot(corner(triangle, 0))};
  }

  /// Grows a patch and marks its triangles. The order of the triangles is that in which the patch took them.
  SurfacePatch grown(std::uint32_t seed, std::uint32_t number)
  {
    SurfacePatch patch;
    std::vector<Plane> planes;
    std::vector<Vector3d> points;
    const auto take = [&](std::uint32_t triangle)
    {
      patch.push_back(triangle);
      patch_of_[triangle] = number;
      planes.push_back(planeOf(triangle));
      for (std::size_t i = 0; i < 3; ++i)
        if (std::find(points.rbegin(), points.rend(), corner(triangle, i)) == points.rend())
          points.push_back(corner(triangle, i));
    };
    const auto fits = [&](std::uint32_t triangle)
    {
      const Plane plane = planeOf(triangle);
      for (std::size_t i = 0; i < 3; ++i)
        for (const Plane& other : planes)
          if (other.normal.dot(corner(triangle, i)) > other.offset + tolerance_)
            return false;
      return std::all_of(points.begin(), points.end(),
                         [&](const Vector3d& point) { return plane.normal.dot(point) <= plane.offset + tolerance_; });
    };
    take(seed);
    for (std::size_t i = 0; i < patch.size(); ++i)
      for (const std::uint32_t next : neighbors_[patch[i]])
        if (next != kNone && patch_of_[next] == kNone && fits(next))
          take(next);
    return patch;
  }

  /// Whether the hull of the first `count` triangles of a patch cuts no other part of the mesh. A flat hull must be
  /// covered by its patch.
  bool isClean(const SurfacePatch& patch, std::size_t count) const
  {
    if (count == 1)
      return true;
    std::vector<Vector3d> points;
    double area = 0.0;
    Eigen::AlignedBox3d box;
    std::vector<std::uint32_t> own(patch.begin(), patch.begin() + static_cast<std::ptrdiff_t>(count));
    std::sort(own.begin(), own.end());
    for (const std::uint32_t triangle : own)
    {
      for (std::size_t i = 0; i < 3; ++i)
        points.push_back(corner(triangle, i));
      area += 0.5 * (corner(triangle, 1) - corner(triangle, 0)).cross(corner(triangle, 2) - corner(triangle, 0)).norm();
      box.extend(boxes_[triangle]);
    }
    const ConvexHull hull = convexHull(points, 0.1 * tolerance_);
    if (hull.facets.empty())
      return hull.area <= area + tolerance_ * box.diagonal().norm();
    const auto first = std::lower_bound(by_x_.begin(), by_x_.end(), box.min().x() - widest_,
                                        [this](std::uint32_t i, double x) { return boxes_[i].min().x() < x; });
    for (auto other = first; other != by_x_.end() && boxes_[*other].min().x() <= box.max().x(); ++other)
      if (boxes_[*other].intersects(box) && !std::binary_search(own.begin(), own.end(), *other) &&
          reachesInto(*other, hull))
        return false;
    return true;
  }

  /// Whether a point of the triangle lies inside the hull, by more than ten times the tolerance. Cuts the triangle by
  /// one facet after the other (Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974).
  bool reachesInto(std::uint32_t triangle, const ConvexHull& hull) const
  {
    std::vector<Vector3d> polygon{corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)};
    std::vector<Vector3d> rest;
    for (const HullFacet& facet : hull.facets)
    {
      const auto height = [&](const Vector3d& point)
      { return facet.normal.dot(point) - facet.offset + 10.0 * tolerance_; };
      rest.clear();
      for (std::size_t i = 0; i < polygon.size(); ++i)
      {
        const Vector3d& from = polygon[i];
        const Vector3d& to = polygon[(i + 1) % polygon.size()];
        const double before = height(from);
        const double after = height(to);
        if (before <= 0.0)
          rest.push_back(from);
        if ((before < 0.0 && after > 0.0) || (before > 0.0 && after < 0.0))
          rest.push_back(from + before / (before - after) * (to - from));
      }
      polygon.swap(rest);
      if (polygon.empty())
        return false;
    }
    return true;
  }

  const Mesh& mesh_;
  double tolerance_ = 0.0;
  double widest_ = 0.0;  // of boxes_, along x
  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<std::uint32_t> by_x_;  // triangles, sorted by the least x
  std::vector<std::array<std::uint32_t, 3>> neighbors_;
  std::vector<std::uint32_t> patch_of_;
};
}  // namespace

std::vector<SurfacePatch> convexPatches(const Mesh& mesh)
{
  return Decomposition(mesh).run();
}
}  // namespace gpu_planning_scene::core::literature
