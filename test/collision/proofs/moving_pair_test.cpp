// The displacement bound of points that several joints move.

#include "collision/proofs/moving_pair.h"

#include <random>

#include <gtest/gtest.h>

#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

class DisplacementOfPoints : public testing::Test
{
 protected:
  double uniform(double lower, double upper)
  {
    return std::uniform_real_distribution<double>(lower, upper)(generator_);
  }
  Vector3d randomPoint() { return {uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0)}; }

  std::vector<JointAxis> randomAxes(int count, double largest_travel)
  {
    std::vector<JointAxis> axes;
    for (int i = 0; i < count; ++i)
      axes.push_back({generator_() % 4 == 0, randomPoint(), randomPoint().normalized(), uniform(0.0, largest_travel)});
    return axes;
  }

  /// The place of a point after each joint has moved by a share (-1 to 1) of its travel. The joint nearest to the
  /// second body, which is the last one, moves the point first.
  static Vector3d moved(const std::vector<JointAxis>& axes, const std::vector<double>& shares, Vector3d point)
  {
    for (std::size_t i = axes.size(); i-- > 0;)
    {
      const JointAxis& axis = axes[i];
      const double value = shares[i] * axis.travel;
      if (axis.prismatic)
        point += value * axis.direction;
      else
        point = axis.point + Eigen::AngleAxisd(value, axis.direction) * (point - axis.point);
    }
    return point;
  }

  std::mt19937_64 generator_{kSeed};
};

TEST_F(DisplacementOfPoints, IsWithinTheBoundForAllJointValuesWithinTheTravel)
{
  for (int i = 0; i < 20000; ++i)
  {
    const std::vector<JointAxis> axes = randomAxes(1 + i % 3, 0.5);
    const Vector3d center = randomPoint();
    const double radius = uniform(0.0, 0.3);
    const Vector3d point = center + uniform(0.0, radius) * randomPoint().normalized();
    std::vector<double> shares;
    for (std::size_t k = 0; k < axes.size(); ++k)
      shares.push_back(generator_() % 2 == 0 ? 1.0 : uniform(-1.0, 1.0));
    ASSERT_LE((moved(axes, shares, point) - point).norm(), displacementBound(axes, center, radius) + 1e-12)
        << "seed " << kSeed << ", round " << i;
  }
}

TEST_F(DisplacementOfPoints, ReachesTheBoundForASmallTravelOfOneJoint)
{
  for (int i = 0; i < 100; ++i)
  {
    const std::vector<JointAxis> axes = randomAxes(1, 0.01);
    const Vector3d point = randomPoint();
    EXPECT_GE((moved(axes, {1.0}, point) - point).norm(), 0.999 * displacementBound(axes, point, 0.0));
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
