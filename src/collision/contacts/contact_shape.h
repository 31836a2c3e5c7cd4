#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "collision/geometry/convex_separation.h"
#include "collision/trees/cpu_tree.h"

namespace gpu_planning_scene::core
{
/// A placed shape whose contacts are computed. The tree must outlive it.
struct ContactShape
{
  const CpuTree* tree;
  Eigen::Isometry3d pose;
  bool is_convex;  ///< see isConvexSolid
};

/// A pair of shapes that must keep a required distance, in metres. The poses are in one frame.
struct ContactPair
{
  ContactShape a;
  ContactShape b;
  double required;
};

/// Whether a shape is a primitive, or a mesh that bounds one convex solid. It tests each triangle of a convex mesh.
bool isConvexSolid(const CpuTree& tree);

/// The convex hull of a shape's surface, without the radius of a sphere: the hull of a sphere is its centre. `pose`: in
/// any frame. Not thread-safe.
class ShapeHull final : public Convex
{
 public:
  ShapeHull(const CpuTree& tree, const Eigen::Isometry3d& pose) : tree_(tree), pose_(pose) {}

  Eigen::Vector3d farthest(const Eigen::Vector3d& direction) const override;
  Eigen::Vector3d center() const override { return pose_ * tree_.center; }
  double radius() const override { return tree_.half.norm(); }

 private:
  const CpuTree& tree_;
  Eigen::Isometry3d pose_;
  mutable std::vector<std::uint32_t> stack_;
};

/// The convex hull of points.
class PointHull final : public Convex
{
 public:
  /// At least one point.
  explicit PointHull(std::vector<Eigen::Vector3d> points);

  Eigen::Vector3d farthest(const Eigen::Vector3d& direction) const override;
  Eigen::Vector3d center() const override { return center_; }
  double radius() const override { return radius_; }

 private:
  std::vector<Eigen::Vector3d> points_;
  Eigen::Vector3d center_;
  double radius_;
};

/// The radius of a sphere; 0 for any other shape.
double sphereRadius(const CpuTree& tree);

/// The separation of the hulls of two shapes, in the frame of the poses. The points lie on the surfaces of the hulls.
ConvexSeparation hullSeparation(const ContactShape& a, const ContactShape& b);

/// Whether hullSeparation gives the distance of shapes that are apart to 1e-7 m: both are convex, their diagonals are
/// together at most 200 m long, and not both are curved (see separationOf).
bool hasExactSeparation(const ContactShape& a, const ContactShape& b);

/// The coordinate of the shape's farthest point along a direction.
double reachOf(const ContactShape& shape, const Eigen::Vector3d& direction);

/// A point that is outside a shape by at most this length belongs to the shape.
constexpr double kOnShape = 1e-8;  // metres

/// Whether a point belongs to a shape: it is inside its solid, or within kOnShape of its surface.
bool contains(const ContactShape& shape, const Eigen::Vector3d& point);

/// A lower bound of the distance of a point inside a shape from its surface, in metres; 0 if the point is outside.
double depthInside(const ContactShape& shape, const Eigen::Vector3d& point);
}  // namespace gpu_planning_scene::core
