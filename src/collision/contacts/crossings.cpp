#include "collision/contacts/crossings.h"

#include <algorithm>
#include <optional>

#include "collision/geometry/cpu_box_pair.h"
#include "collision/geometry/primitive_solid.h"

// A simultaneous traversal of two trees of oriented boxes (Gottschalk, Lin and Manocha, "OBBTree", 1996) that goes on
// after the first pair of triangles that meet.
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kCrossingMargin = 1e-9;  // metres; exceeds the rounding of the box tests plus kSlack
constexpr double kMeetAccuracy = 1e-8;    // metres

Triangle moved(const Triangle& t, const Isometry3d& pose)
{
  return {pose * t[0], pose * t[1], pose * t[2]};
}

std::vector<ShapeParts> crossingsOfSurfaces(const CpuTree& a, const CpuTree& b, const Isometry3d& b_in_a, double reach,
                                            std::size_t most)
{
  std::vector<ShapeParts> found;
  std::vector<std::array<std::uint32_t, 2>> stack;
  const auto push = [&](std::uint32_t in_a, std::uint32_t in_b)
  {
    if (overlap(a.nodes[in_a].box, placed(b.nodes[in_b].box, b_in_a), reach + kCrossingMargin))
      stack.push_back({in_a, in_b});
  };
  push(0, 0);
  while (!stack.empty())
  {
    const auto [in_a, in_b] = stack.back();
    stack.pop_back();
    const CpuNode& node_a = a.nodes[in_a];
    const CpuNode& node_b = b.nodes[in_b];
    if (!node_a.isLeaf() || !node_b.isLeaf())
    {
      const bool open_a = opensFirst(node_a, node_b);
      for (std::uint32_t i = 0; i < 2; ++i)
        push(open_a ? node_a.first + i : in_a, open_a ? in_b : node_b.first + i);
      continue;
    }
    for (std::uint32_t j = node_b.first; j < node_b.first + node_b.count; ++j)
    {
      const Triangle of_b = moved(b.triangles[j], b_in_a);
      for (std::uint32_t i = node_a.first; i < node_a.first + node_a.count; ++i)
      {
        if (!trianglesWithin(a.triangles[i], of_b, reach))
          continue;
        found.push_back({i, j});
        if (found.size() >= most)
          return found;
      }
    }
  }
  return found;
}

/// The triangles of a mesh that are within reach of a primitive.
std::vector<std::uint32_t> trianglesNear(const CpuTree& mesh, const CpuTree& solid, const Isometry3d& mesh_in_solid,
                                         double reach, std::size_t most)
{
  std::vector<std::uint32_t> found;
  std::vector<std::uint32_t> stack(1, 0);
  while (!stack.empty())
  {
    const CpuNode& node = mesh.nodes[stack.back()];
    stack.pop_back();
    if (!overlap(solid.box, placed(node.box, mesh_in_solid), reach + kCrossingMargin) ||
        distanceToSolid(solid.shape, mesh_in_solid * node.box.center) > node.box.half.norm() + reach + kCrossingMargin)
      continue;
    if (!node.isLeaf())
    {
      stack.push_back(node.first);
      stack.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    {
      if (!triangleWithinSolid(moved(mesh.triangles[i], mesh_in_solid), solid.shape, reach))
        continue;
      found.push_back(i);
      if (found.size() >= most)
        return found;
    }
  }
  return found;
}

/// The ends of the segment in which two triangles cross each other; none if they do not cross.
class CommonSegment
{
 public:
  CommonSegment(const Triangle& a, const Triangle& b)
  {
    for (int i = 0; i < 3; ++i)
    {
      offerEdge(a[i], a[(i + 1) % 3], b);
      offerEdge(b[i], b[(i + 1) % 3], a);
    }
  }

  std::optional<Vector3d> middle() const
  {
    if (count_ == 0)
      return std::nullopt;
    return sum_ / static_cast<double>(count_);
  }

 private:
  /// All points offered lie in both triangles, so their mean does too.
  void offerEdge(const Vector3d& start, const Vector3d& end, const Triangle& triangle)
  {
    const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    const double from = normal.dot(start - triangle[0]);
    const double to = normal.dot(end - triangle[0]);
    if (!(from * to <= 0.0) || from == to)
      return;
    const Vector3d point = start + from / (from - to) * (end - start);
    if ((nearestPoint(triangle, point) - point).norm() > kMeetAccuracy)
      return;
    sum_ += point;
    ++count_;
  }

  Vector3d sum_ = Vector3d::Zero();
  int count_ = 0;
};

std::array<Vector3d, 2> pointsOfTriangles(const Triangle& a, const Triangle& b)
{
  if (const auto middle = CommonSegment(a, b).middle())
    return {*middle, *middle};
  // Triangles that only touch, are coplanar, or are apart. A point of the common part of coplanar triangles is a corner
  // of one of them, or the crossing of two edges.
  const ConvexSeparation found = separationOf(PointHull({a[0], a[1], a[2]}), PointHull({b[0], b[1], b[2]}));
  std::array<Vector3d, 2> best = {found.on_a, found.on_b};
  const auto offer = [&best](const Vector3d& on_a, const Vector3d& on_b)
  {
    if ((on_a - on_b).squaredNorm() < (best[0] - best[1]).squaredNorm())
      best = {on_a, on_b};
  };
  for (int i = 0; i < 3; ++i)
  {
    offer(a[i], nearestPoint(b, a[i]));
    offer(nearestPoint(a, b[i]), b[i]);
    for (int j = 0; j < 3; ++j)
    {
      const Vector3d u = a[(i + 1) % 3] - a[i];
      const Vector3d v = b[(j + 1) % 3] - b[j];
      const Vector3d w = a[i] - b[j];
      const Vector3d n = u.cross(v);
      const double nn = n.squaredNorm();
      if (!(nn > 0.0))
        continue;
      const double s = std::clamp(v.cross(w).dot(n) / nn, 0.0, 1.0);
      const double t = std::clamp(u.cross(w).dot(n) / nn, 0.0, 1.0);
      offer(a[i] + s * u, b[j] + t * v);
    }
  }
  return best;
}

/// `triangle`: in the frame of the solid. The first point is on the triangle, the second one in the solid.
std::array<Vector3d, 2> pointsOfTriangleAndSolid(const Triangle& triangle, const CpuTree& solid)
{
  const PointHull corners({triangle[0], triangle[1], triangle[2]});
  const ShapeHull hull(solid, Isometry3d::Identity());
  const ConvexSeparation found = separationOf(corners, hull);
  if (found.depth > 0.0)
  {
    const Vector3d point = commonPoint(corners, hull);
    return {point, point};
  }
  // The hull of a sphere is its centre.
  const double radius = sphereRadius(solid);
  if (found.depth + radius > 0.0)
    return {found.on_a, radius > 0.0 ? found.on_a : found.on_b};
  return {found.on_a, found.on_b - radius * found.normal};
}
}  // namespace

std::vector<ShapeParts> crossingsOf(const ContactShape& a, const ContactShape& b, double reach, std::size_t most)
{
  if (a.tree->mesh && b.tree->mesh)
    return crossingsOfSurfaces(*a.tree, *b.tree, relativePose(a.pose, b.pose), reach, most);
  std::vector<ShapeParts> found;
  if (a.tree->mesh)
    for (const std::uint32_t i : trianglesNear(*a.tree, *b.tree, relativePose(b.pose, a.pose), reach, most))
      found.push_back({i, ShapeParts::kWhole});
  else
    for (const std::uint32_t i : trianglesNear(*b.tree, *a.tree, relativePose(a.pose, b.pose), reach, most))
      found.push_back({ShapeParts::kWhole, i});
  return found;
}

std::vector<ShapeParts> crossingsOfBoxes(const ContactShape& a, const ContactShape& b, std::size_t most)
{
  if (a.tree->triangles.empty() || b.tree->triangles.empty())
    return {};
  return crossingsOfSurfaces(*a.tree, *b.tree, relativePose(a.pose, b.pose), 0.0, most);
}

Triangle placedTriangle(const ContactShape& shape, std::uint32_t number)
{
  return moved(shape.tree->triangles[number], shape.pose);
}

std::array<Vector3d, 2> pointsOf(const ContactShape& a, const ContactShape& b, const ShapeParts& crossing)
{
  if (crossing.of_a == ShapeParts::kWhole)
  {
    const auto [on_b, on_a] = pointsOf(b, a, {crossing.of_b, crossing.of_a});
    return {on_a, on_b};
  }
  // Both in the frame of one shape, so that no digits are lost far from the origin.
  if (crossing.of_b == ShapeParts::kWhole)
  {
    const auto [on_a, on_b] =
        pointsOfTriangleAndSolid(moved(a.tree->triangles[crossing.of_a], relativePose(b.pose, a.pose)), *b.tree);
    return {b.pose * on_a, b.pose * on_b};
  }
  const auto [on_a, on_b] = pointsOfTriangles(a.tree->triangles[crossing.of_a],
                                              moved(b.tree->triangles[crossing.of_b], relativePose(a.pose, b.pose)));
  return {a.pose * on_a, a.pose * on_b};
}
}  // namespace gpu_planning_scene::core
