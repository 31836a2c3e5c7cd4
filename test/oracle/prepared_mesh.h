#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/solids.h"
#include "oracle/triangle.h"

namespace gpu_planning_scene::core::oracle
{
/// A box in a shape's frame, in double. It contains the whole shape in spite of rounding.
struct BoundingBox
{
  Eigen::Vector3d center;
  Eigen::Vector3d half;
};

/// A lower bound of the distance of the contents of two boxes, for b placed in a's frame. It accounts for rounding in
/// double.
double leastDistance(const BoundingBox& a, const BoundingBox& b, const Eigen::Isometry3d& b_in_a);

/// A closed mesh with a tree of boxes over its triangles, its connected components, and the solid that its triangles
/// bound by their roles.
class PreparedMesh
{
 public:
  explicit PreparedMesh(const SolidMesh& solid);

  /// A leaf has one triangle. The root is node 0. The two children of an inner node are `child` and `child + 1`.
  struct Node
  {
    BoundingBox box;
    std::uint32_t child = 0;  ///< 0: a leaf
    std::uint32_t triangle = 0;
  };
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// The corners of the triangles in double; they are exact.
  const std::vector<TriangleCorners>& corners() const { return corners_; }

  /// One vertex of each connected component.
  const std::vector<Eigen::Vector3d>& componentPoints() const { return component_points_; }
  bool hasSolid() const { return !winding_triangles_.empty() || !parity_triangles_.empty(); }

  /// Whether the winding number around the point is not 0, or the number of crossings is odd, see TriangleRole. A point
  /// on the surface may count as inside or outside.
  bool solidContains(const Vector& point) const;

 private:
  void findComponents(const SolidMesh& solid);
  void build(std::uint32_t node, std::uint32_t begin, std::uint32_t end, std::vector<std::uint32_t>& order,
             const std::vector<Eigen::AlignedBox3d>& boxes);

  std::vector<Triangle> triangles_;
  std::vector<TriangleCorners> corners_;
  std::vector<Node> nodes_;
  std::vector<Eigen::Vector3d> component_points_;
  std::vector<TriangleCorners> winding_triangles_;
  std::vector<TriangleCorners> parity_triangles_;
  Eigen::AlignedBox3d solid_box_;
};
}  // namespace gpu_planning_scene::core::oracle
