#pragma once

#include <Eigen/Geometry>

namespace gpu_planning_scene
{
/// Whether two oriented boxes overlap, by their 15 possible separating axes, after Gottschalk, Lin and Manocha,
/// "OBBTree" (1996). Boxes given by centres and half lengths; the orientation of the second in the frame of the first
/// is fixed at construction, as it is for all node pairs of two trees.
class BoxPairTest
{
 public:
  explicit BoxPairTest(const Eigen::Matrix3d& rotation) : r_(rotation), abs_r_(rotation.cwiseAbs().array() + kParallel)
  {
  }

  /// `t`: from the centre of the first box to that of the second, in the frame of the first.
  bool overlap(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& t) const
  {
    for (int i = 0; i < 3; ++i)
    {
      if (std::abs(t[i]) > a[i] + abs_r_.row(i).dot(b))
      {
        return false;
      }
    }
    for (int j = 0; j < 3; ++j)
    {
      if (std::abs(t.dot(r_.col(j))) > a.dot(abs_r_.col(j)) + b[j])
      {
        return false;
      }
    }
    for (int i = 0; i < 3; ++i)
    {
      const int i1 = (i + 1) % 3;
      const int i2 = (i + 2) % 3;
      for (int j = 0; j < 3; ++j)
      {
        const int j1 = (j + 1) % 3;
        const int j2 = (j + 2) % 3;
        const double distance = std::abs(t[i2] * r_(i1, j) - t[i1] * r_(i2, j));
        if (distance > a[i1] * abs_r_(i2, j) + a[i2] * abs_r_(i1, j) + b[j1] * abs_r_(i, j2) + b[j2] * abs_r_(i, j1))
        {
          return false;
        }
      }
    }
    return true;
  }

 private:
  // Keeps rounding from separating boxes by the cross product of two edges that are parallel but for rounding.
  static constexpr double kParallel = 1e-14;

  Eigen::Matrix3d r_;
  Eigen::Matrix3d abs_r_;
};
}  // namespace gpu_planning_scene
