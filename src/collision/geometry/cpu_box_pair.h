#pragma once

#include <cmath>

#include <Eigen/Geometry>

#include "collision/geometry/oriented_box.h"

namespace gpu_planning_scene::core
{
/// Two boxes, in the frame of the first one's axes: half lengths, the way from the first centre to the second, and the
/// axes of the second. Whether they overlap, by their 15 possible separating axes, after Gottschalk, Lin and Manocha,
/// "OBBTree" (1996). Axes are asked for in the order of the functions here: edges only of boxes that the faces of the
/// first do not separate, as kParallel counts on that.
struct BoxPair
{
  // Keeps rounding from separating boxes by the cross product of two edges that are parallel but for rounding: more
  // than the axes of nodes and the poses of links are off from orthonormal, a few 1e-15.
  static constexpr double kParallel = 1e-14;

  Eigen::Vector3d a;
  Eigen::Vector3d b;
  Eigen::Vector3d t;
  Eigen::Matrix3d r;      // columns: the axes of b
  Eigen::Matrix3d abs_r;  // absolute values, and kParallel

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

/// Whether boxes overlap of which the orientation of the second in the frame of the first is fixed at construction, as
/// it is for all node pairs of two trees of axis-aligned boxes.
class BoxPairTest
{
 public:
  explicit BoxPairTest(const Eigen::Matrix3d& rotation)
    : r_(rotation), abs_r_(rotation.cwiseAbs().array() + BoxPair::kParallel)
  {
  }

  /// `t`: from the centre of the first box to that of the second, in the frame of the first.
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

inline OrientedBox placed(const OrientedBox& box, const Eigen::Isometry3d& pose)
{
  return {pose.linear() * box.axes, pose * box.center, box.half};
}

/// Whether boxes in one frame overlap where one of them is grown by `growth` on all sides. Computes the rotation
/// between them row by row, as far as it takes to tell the two apart.
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
}  // namespace gpu_planning_scene::core
