#pragma once

#include <cmath>

#include <Eigen/Geometry>

#include "collision/geometry/oriented_box.h"

namespace gpu_planning_scene::core
{
/// Overlap test of two oriented boxes by their 15 possible separating axes (Gottschalk, Lin and Manocha, "OBBTree",
/// 1996). All members are in the frame of the first box: a and b are the half lengths, t is the vector from the first
/// centre to the second, and r holds the axes of the second box. Call the functions in the order of their definition:
/// kParallel is large enough for the edge axes only if no face of the first box separates the boxes.
struct BoxPair
{
  // The cross product of two nearly parallel edges is mostly rounding error. This term prevents such an axis from
  // separating the boxes. It is larger than the deviation from orthonormal axes of nodes and link poses, a few 1e-15.
  static constexpr double kParallel = 1e-14;

  Eigen::Vector3d a;
  Eigen::Vector3d b;
  Eigen::Vector3d t;
  Eigen::Matrix3d r;      // columns: the axes of b
  Eigen::Matrix3d abs_r;  // absolute values of r, plus kParallel

  bool apartAlongFaceOfA(int i) const
  {
    return std::abs(t[i]) > a[i] + abs_r(i, 0) * b[0] + abs_r(i, 1) * b[1] + abs_r(i, 2) * b[2];
  }

  bool apartAlongFacesOfB() const
  {
    for (int j = 0; j < 3; ++j)
    {
      const double distance = std::abs(t[0] * r(0, j) + t[1] * r(1, j) + t[2] * r(2, j));
      if (distance > a[0] * abs_r(0, j) + a[1] * abs_r(1, j) + a[2] * abs_r(2, j) + b[j])
        return true;
    }
    return false;
  }

  bool apartAlongEdges() const
  {
    for (int i = 0; i < 3; ++i)
    {
      const int i1 = (i + 1) % 3;
      const int i2 = (i + 2) % 3;
      for (int j = 0; j < 3; ++j)
      {
        const int j1 = (j + 1) % 3;
        const int j2 = (j + 2) % 3;
        const double distance = std::abs(t[i2] * r(i1, j) - t[i1] * r(i2, j));
        if (distance > a[i1] * abs_r(i2, j) + a[i2] * abs_r(i1, j) + b[j1] * abs_r(i, j2) + b[j2] * abs_r(i, j1))
          return true;
      }
    }
    return false;
  }
};

/// The same test for many pairs of boxes with one relative orientation, which is fixed at construction. All node pairs
/// of two trees of axis-aligned boxes have the same relative orientation.
class BoxPairTest
{
 public:
  explicit BoxPairTest(const Eigen::Matrix3d& rotation)
    : r_(rotation), abs_r_(rotation.cwiseAbs().array() + BoxPair::kParallel)
  {
  }

  /// `a`, `b`: half lengths. `t`: vector from the centre of the first box to the centre of the second, in the frame of
  /// the first.
  bool overlap(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& t) const
  {
    const BoxPair pair{a, b, t, r_, abs_r_};
    return !pair.apartAlongFaceOfA(0) && !pair.apartAlongFaceOfA(1) && !pair.apartAlongFaceOfA(2) &&
           !pair.apartAlongFacesOfB() && !pair.apartAlongEdges();
  }

 private:
  Eigen::Matrix3d r_;
  Eigen::Matrix3d abs_r_;
};

/// The pose of b in the frame of a. The translations are subtracted first, so no digits are lost if both are far from
/// the origin.
inline Eigen::Isometry3d relativePose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
  Eigen::Isometry3d b_in_a;
  b_in_a.linear().noalias() = a.linear().transpose() * b.linear();
  b_in_a.translation().noalias() = a.linear().transpose() * (b.translation() - a.translation());
  b_in_a.makeAffine();
  return b_in_a;
}

/// The product of a pose and a point. GCC does not inline Eigen's.
inline Eigen::Vector3d transformed(const Eigen::Vector3d& point, const Eigen::Isometry3d& pose)
{
  return pose.linear() * point + pose.translation();
}

inline OrientedBox placed(const OrientedBox& box, const Eigen::Isometry3d& pose)
{
  return {pose.linear() * box.axes, transformed(box.center, pose), box.half};
}

/// Whether two boxes in one frame overlap after the first box has been grown by `growth` on all sides. Computes the
/// relative rotation row by row, and only until a face of the first box separates the boxes.
inline bool overlap(const OrientedBox& a, const OrientedBox& b, double growth)
{
  BoxPair pair;
  pair.a = a.half.array() + growth;
  pair.b = b.half;
  const Eigen::Vector3d between = b.center - a.center;
  for (int i = 0; i < 3; ++i)
  {
    const double x = a.axes(0, i);
    const double y = a.axes(1, i);
    const double z = a.axes(2, i);
    for (int j = 0; j < 3; ++j)
    {
      pair.r(i, j) = x * b.axes(0, j) + y * b.axes(1, j) + z * b.axes(2, j);
      pair.abs_r(i, j) = std::abs(pair.r(i, j)) + BoxPair::kParallel;
    }
    pair.t[i] = x * between[0] + y * between[1] + z * between[2];
    if (pair.apartAlongFaceOfA(i))
      return false;
  }
  return !pair.apartAlongFacesOfB() && !pair.apartAlongEdges();
}

/// Whether the line of the centres is an axis along which two boxes in one frame are farther apart than `distance`. For
/// a distance that is long against the boxes, this test separates more boxes than overlap(): the corners of a grown box
/// are farther away than the distance. The caller adds a margin to `distance` that exceeds the rounding errors.
inline bool apartAlongCenters(const OrientedBox& a, const OrientedBox& b, double distance)
{
  const Eigen::Vector3d between = b.center - a.center;
  const double reach_a = (a.axes.transpose() * between).cwiseAbs().dot(a.half);
  const double reach_b = (b.axes.transpose() * between).cwiseAbs().dot(b.half);
  const double squared = between.squaredNorm();
  return squared - (reach_a + reach_b) > distance * std::sqrt(squared);
}
}  // namespace gpu_planning_scene::core
