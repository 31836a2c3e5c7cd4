#include "oracle/oracle.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "oracle/convex.h"
#include "oracle/prepared_mesh.h"

namespace gpu_planning_scene::core::oracle
{
struct PreparedShape::Impl
{
  // Exactly one of these three is set.
  std::unique_ptr<PreparedMesh> mesh;
  std::optional<Convex> convex;
  std::optional<HalfSpace> half_space;
  BoundingBox box;  // bounds `mesh` or `convex`
};

namespace
{
/// A distance is computed exactly if it lies between `required` and `limit`. Below `required`, any value of at most
/// `required` is a correct result; above `limit`, any value of at least `limit`.
struct Range
{
  Quad required;
  Quad limit;
};

/// Two points that are nearer than this are equal up to the rounding of quadruple precision (metres).
const Quad kRounding = 1e-20;

Eigen::Vector3d halfSize(const Convex& convex)
{
  const auto extent = [&](const Vector& direction)
  { return static_cast<double>(dot(farthestPoint(convex, direction), direction)); };
  return (1.0 + 1e-14) * Eigen::Vector3d(extent({1, 0, 0}), extent({0, 1, 0}), extent({0, 0, 1}));
}

Quad convexDistance(const Convex& a, const Motion& pose_a, const Convex& b, const Motion& pose_b, const Range& range)
{
  const Bounds bounds = convexDistance(a, pose_a, b, pose_b, range.required, range.limit);
  return bounds.lower > range.limit ? range.limit : bounds.upper;
}

/// The smallest distance over all pairs of triangles, by a simultaneous descent of both trees.
class MeshPair
{
 public:
  MeshPair(const PreparedMesh& a, const PreparedMesh& b, const Motion& b_in_a, const Range& range)
    : a_(a),
      b_(b),
      b_in_a_(b_in_a),
      rounded_(b_in_a.toDouble()),
      slack_(roundingOf(b, rounded_)),
      required_(range.required),
      best_(range.limit)
  {
    descend(0, 0);
  }
  Quad best() const { return best_; }

 private:
  /// A bound of the rounding of a corner p of the mesh that a motion (R, t) moves in double. Rounding of R and t and
  /// five roundings of R p + t add up to less than 9.6e-16 |p| + 5.6e-16 |t|.
  static double roundingOf(const PreparedMesh& mesh, const Eigen::Isometry3d& motion)
  {
    const BoundingBox& box = mesh.nodes()[0].box;
    return 2e-15 * (box.center.norm() + box.half.norm() + motion.translation().norm());
  }

  double bound(std::uint32_t a, std::uint32_t b) const
  {
    return leastDistance(a_.nodes()[a].box, b_.nodes()[b].box, rounded_);
  }

  void descend(std::uint32_t a, std::uint32_t b)
  {
    const PreparedMesh::Node& node_a = a_.nodes()[a];
    const PreparedMesh::Node& node_b = b_.nodes()[b];
    if (best_ <= required_ || bound(a, b) > best_)
      return;
    if (node_a.child == 0 && node_b.child == 0)
    {
      const TriangleCorners& of_b = b_.corners()[node_b.triangle];
      const TriangleCorners rounded = {rounded_ * of_b[0], rounded_ * of_b[1], rounded_ * of_b[2]};
      if (leastDistance(a_.corners()[node_a.triangle], rounded) - slack_ > best_)
        return;
      const auto& corners = b_.triangles()[node_b.triangle].corners;
      const Triangle moved({b_in_a_ * corners[0], b_in_a_ * corners[1], b_in_a_ * corners[2]});
      best_ = std::min(best_, oracle::distance(a_.triangles()[node_a.triangle], moved, best_));
      return;
    }
    const bool split_a =
        node_b.child == 0 || (node_a.child != 0 && node_a.box.half.squaredNorm() > node_b.box.half.squaredNorm());
    const std::array<std::uint32_t, 2> first = {split_a ? node_a.child : a, split_a ? b : node_b.child};
    const std::array<std::uint32_t, 2> second = {split_a ? node_a.child + 1 : a, split_a ? b : node_b.child + 1};
    const bool swap = bound(second[0], second[1]) < bound(first[0], first[1]);
    const auto& near = swap ? second : first;
    const auto& far = swap ? first : second;
    descend(near[0], near[1]);
    descend(far[0], far[1]);
  }

  const PreparedMesh& a_;
  const PreparedMesh& b_;
  Motion b_in_a_;
  Eigen::Isometry3d rounded_;
  double slack_;  // metres; see roundingOf()
  Quad required_;
  Quad best_;
};

bool componentInside(const PreparedMesh& outer, const PreparedMesh& inner, const Motion& inner_in_outer)
{
  return outer.hasSolid() &&
         std::any_of(
             inner.componentPoints().begin(), inner.componentPoints().end(),
             [&](const Eigen::Vector3d& p) { return outer.solidContains(inner_in_outer * Vector(p)); });
}

Quad distanceOf(const PreparedMesh& a, const PreparedMesh& b, const Motion& b_in_a, const Range& range)
{
  const Quad surfaces = MeshPair(a, b, b_in_a, range).best();
  if (surfaces <= range.required)
    return surfaces;
  return componentInside(a, b, b_in_a) || componentInside(b, a, b_in_a.inverse()) ? Quad(0) : surfaces;
}

Quad distanceOf(const PreparedMesh& mesh, const PreparedShape::Impl& solid, const Motion& solid_in_mesh,
                const Range& range)
{
  const Eigen::Isometry3d rounded = solid_in_mesh.toDouble();
  Quad best = range.limit;
  std::vector<std::uint32_t> open = {0};
  while (!open.empty() && best > range.required)
  {
    const PreparedMesh::Node& node = mesh.nodes()[open.back()];
    open.pop_back();
    if (leastDistance(node.box, solid.box, rounded) > best)
      continue;
    if (node.child == 0)
    {
      const Convex triangle = Corners{mesh.triangles()[node.triangle].corners};
      best = std::min(best, convexDistance(triangle, {}, *solid.convex, solid_in_mesh, {range.required, best}));
      continue;
    }
    open.push_back(node.child);
    open.push_back(node.child + 1);
  }
  return best > range.required && mesh.solidContains(solid_in_mesh.translation) ? Quad(0) : best;
}

Quad distanceOf(const PreparedShape::Impl& shape, const HalfSpace& half_space, const Motion& shape_in_half_space)
{
  const Vector normal(half_space.normal);
  const auto height = [&](const Vector& p) { return dot(normal, p) - half_space.offset; };
  Quad least;
  if (shape.convex)
  {
    const Vector down = shape_in_half_space.unrotate(-normal);
    least = height(shape_in_half_space * farthestPoint(*shape.convex, down));
  }
  else
  {
    least = height(shape_in_half_space * shape.mesh->triangles()[0].corners[0]);
    for (const Triangle& triangle : shape.mesh->triangles())
      for (const Vector& corner : triangle.corners)
        least = std::min(least, height(shape_in_half_space * corner));
  }
  return std::max(Quad(0), least / length(normal));
}

Quad distanceOf(const PreparedShape& first, const Motion& pose_a, const PreparedShape& second, const Motion& pose_b,
                const Range& range)
{
  const PreparedShape::Impl& a = first.impl();
  const PreparedShape::Impl& b = second.impl();
  const Motion b_in_a = pose_a.inverse() * pose_b;
  if (a.half_space)
    return distanceOf(b, *a.half_space, b_in_a);
  if (b.half_space)
    return distanceOf(a, *b.half_space, b_in_a.inverse());
  if (leastDistance(a.box, b.box, b_in_a.toDouble()) > range.limit)
    return range.limit;
  if (a.mesh && b.mesh)
    return distanceOf(*a.mesh, *b.mesh, b_in_a, range);
  if (a.mesh)
    return distanceOf(*a.mesh, b, b_in_a, range);
  if (b.mesh)
    return distanceOf(*b.mesh, a, b_in_a.inverse(), range);
  return convexDistance(*a.convex, {}, *b.convex, b_in_a, range);
}
}  // namespace

PreparedShape::PreparedShape(const Shape& shape)
{
  auto impl = std::make_unique<Impl>();
  if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&shape))
  {
    impl->mesh = std::make_unique<PreparedMesh>(*solidMeshOf(*mesh));
    impl->box = impl->mesh->nodes()[0].box;
  }
  else if (const auto* half_space = std::get_if<HalfSpace>(&shape))
    impl->half_space = *half_space;
  else if (const auto* box = std::get_if<Box>(&shape))
    impl->convex = *box;
  else if (const auto* sphere = std::get_if<Sphere>(&shape))
    impl->convex = *sphere;
  else if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    impl->convex = *cylinder;
  else
    impl->convex = std::get<Cone>(shape);
  if (impl->convex)
    impl->box = {Eigen::Vector3d::Zero(), halfSize(*impl->convex)};
  impl_ = std::move(impl);
}

PreparedShape::~PreparedShape() = default;

double distance(const PreparedShape& a, const Motion& pose_a, const PreparedShape& b, const Motion& pose_b,
                double limit)
{
  return static_cast<double>(distanceOf(a, pose_a, b, pose_b, {kRounding, limit}));
}

Verdict verdict(const PreparedShape& a, const Motion& pose_a, const PreparedShape& b, const Motion& pose_b,
                double required_distance)
{
  const Range range = {Quad(required_distance) + kRounding, Quad(required_distance) + Quad(kTolerance)};
  const Quad found = distanceOf(a, pose_a, b, pose_b, range);
  return found <= range.required ? Verdict::Collides : found < range.limit ? Verdict::Either : Verdict::Free;
}
}  // namespace gpu_planning_scene::core::oracle
