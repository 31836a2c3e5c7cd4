#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Geometry>

#include "collision/geometry/triangle_pair.h"

namespace gpu_planning_scene::core
{
/// A box with its own axes (oriented bounding box, OBB).
struct OrientedBox
{
  Eigen::Matrix3d axes;  ///< columns: orthonormal up to rounding
  Eigen::Vector3d center;
  Eigen::Vector3d half;  ///< half lengths along the axes

  bool contains(const Eigen::Vector3d& point) const
  {
    return ((axes.transpose() * (point - center)).cwiseAbs().array() <= half.array()).all();
  }
};

/// A measure that is proportional to the surface of a box: half of the surface from full lengths, an eighth of it from
/// half lengths.
inline double surfaceMeasure(const Eigen::Vector3d& lengths)
{
  return lengths.x() * lengths.y() + lengths.y() * lengths.z() + lengths.z() * lengths.x();
}

/// Statistics of a set of triangles from which the axes of its box are chosen. The statistics of the union of two sets
/// follow from the statistics of the two sets.
class TriangleSpread
{
 public:
  TriangleSpread() = default;
  explicit TriangleSpread(const Triangle& triangle);
  TriangleSpread(const TriangleSpread& a, const TriangleSpread& b);

  /// The main axes of the triangles' corners: the eigenvectors of their covariance (as in Gottschalk, Lin and Manocha,
  /// "OBBTree", 1996).
  Eigen::Matrix3d mainAxes() const;

  const Eigen::Vector3d& edge() const { return edge_; }      ///< middle edge of the largest triangle, see AxesChoice
  const Eigen::Vector3d& normal() const { return normal_; }  ///< of the largest triangle; length: twice its area

 private:
  double corners_ = 0.0;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter_ = Eigen::Matrix3d::Zero();  // the covariance times the number of corners
  Eigen::Vector3d edge_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();
};

/// Candidates for the axes of a box: the axes of the frame, the main axes, and two choices from the largest triangle
/// unless it is a sliver. Both contain the normal of the largest triangle. One adds its edge of middle length, which is
/// a side of the rectangle if the triangle is half of a rectangle. The other adds the axis of the frame that is nearest
/// to the triangle's plane.
struct AxesChoice
{
  std::array<Eigen::Matrix3d, 4> axes;  // right-handed, orthonormal up to rounding
  std::size_t count;                    // at least the first two
};
AxesChoice axesChoice(const TriangleSpread& spread);

/// The smallest box with the given axes that contains the corners of `count` triangles (at least 1). The box is
/// enlarged by the possible rounding error, so OrientedBox::contains is true for each corner.
OrientedBox boxAlong(const Eigen::Matrix3d& axes, const Triangle* triangles, std::size_t count);

/// The box of least surface among the boxes along axesChoice(spread). `spread` must belong to these triangles.
OrientedBox fitOrientedBox(const TriangleSpread& spread, const Triangle* triangles, std::size_t count);
}  // namespace gpu_planning_scene::core
