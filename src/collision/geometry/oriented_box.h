#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Geometry>

#include "collision/geometry/triangle_pair.h"

namespace gpu_planning_scene::core
{
/// A box with axes of its own (OBB).
struct OrientedBox
{
  Eigen::Matrix3d axes;  ///< columns, orthonormal to rounding
  Eigen::Vector3d center;
  Eigen::Vector3d half;  ///< along the axes

  bool holds(const Eigen::Vector3d& point) const
  {
    return ((axes.transpose() * (point - center)).cwiseAbs().array() <= half.array()).all();
  }
};

/// The surface of a box but for a factor: half of it from full lengths, an eighth from half lengths.
inline double surfaceMeasure(const Eigen::Vector3d& lengths)
{
  return lengths.x() * lengths.y() + lengths.y() * lengths.z() + lengths.z() * lengths.x();
}

/// What the axes of a box around triangles are chosen by. Of two sets together it follows from those of each.
class TriangleSpread
{
 public:
  TriangleSpread() = default;
  explicit TriangleSpread(const Triangle& triangle);
  TriangleSpread(const TriangleSpread& a, const TriangleSpread& b);

  /// The main axes of the corners: the eigenvectors of their covariance.
  Eigen::Matrix3d mainAxes() const;

  const Eigen::Vector3d& edge() const { return edge_; }      ///< see AxesChoice
  const Eigen::Vector3d& normal() const { return normal_; }  ///< of the largest triangle, twice its area long

 private:
  double corners_ = 0.0;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter_ = Eigen::Matrix3d::Zero();  // the covariance times the number of corners
  Eigen::Vector3d edge_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();
};

/// Axes of which a box's are chosen: those of the frame, the main axes, and, unless the largest triangle is a sliver,
/// its normal with two directions of its plane: its edge of middle length (of half a rectangle it is a side), and the
/// axis of the frame that is nearest to the plane.
struct AxesChoice
{
  std::array<Eigen::Matrix3d, 4> axes;  // right-handed, orthonormal to rounding
  std::size_t count;                    // at least the first two
};
AxesChoice axesChoice(const TriangleSpread& spread);

/// The least box with the given axes that holds the corners of `count` triangles (at least one), enlarged by what
/// rounding may take from it: OrientedBox::holds is true of each.
OrientedBox boxAlong(const Eigen::Matrix3d& axes, const Triangle* triangles, std::size_t count);

/// The box with the least surface of those along axesChoice(spread). `spread`: of these triangles.
OrientedBox fitOrientedBox(const TriangleSpread& spread, const Triangle* triangles, std::size_t count);
}  // namespace gpu_planning_scene::core
