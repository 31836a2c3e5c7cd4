// Waypoints of a path of a floating body. A motion must not depend on the signs of quaternions.

#include <cmath>

#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>

#include "gpu_planning_scene/planning/group_state_space.h"
#include "model/model_testing.h"
#include "planning/space/waypoints.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;
using Row = std::vector<double>;

class FloatingWaypoints : public testing::Test
{
 protected:
  FloatingWaypoints()
    : robot_(robotOf("<link name='base'/><link name='body'/>" + jointXml("free", "floating", "base", "body"),
                     "<group name='all'><joint name='free'/></group>")),
      space_(std::make_shared<GroupStateSpace>(robot_, "all")),
      information_(std::make_shared<ob::SpaceInformation>(space_))
  {
    information_->setStateValidityChecker([](const ob::State*) { return true; });
    information_->setup();
  }

  /// A row with the body rotated about z by `angle`. `sign`: sign of the quaternion.
  static Row turned(double angle, double sign)
  {
    return {0.0, 0.0, 0.0, 0.0, 0.0, sign * std::sin(0.5 * angle), sign * std::cos(0.5 * angle)};
  }

  std::vector<Row> waypoints(const std::vector<Row>& rows)
  {
    PathGeometric path(information_);
    for (const Row& row : rows)
    {
      ob::ScopedState<> state(space_);
      space_->copyFromRow(row.data(), state.get());
      path.append(state.get());
    }
    return waypointsOf(path, *space_, rows.front());
  }

  std::shared_ptr<const RobotModel> robot_;
  std::shared_ptr<GroupStateSpace> space_;
  ob::SpaceInformationPtr information_;
};

TEST_F(FloatingWaypoints, KeepTheSignOfQuaternions)
{
  const std::vector<Row> answered =
      waypoints({turned(0.0, -1.0), turned(1.0, 1.0), turned(2.0, 1.0), turned(3.0, -1.0), turned(1.0, 1.0)});
  ASSERT_EQ(answered.size(), 5U);
  for (std::size_t i = 0; i < answered.size(); ++i)
  {
    const Row expected = turned(i == 4 ? 1.0 : static_cast<double>(i), -1.0);
    for (std::size_t k = 0; k < expected.size(); ++k)
      EXPECT_NEAR(answered[i][k], expected[k], 1e-12) << i << ", " << k;
  }
}

TEST_F(FloatingWaypoints, HaveTheMiddleOfHalfATurn)
{
  const std::vector<Row> answered = waypoints({turned(0.0, 1.0), turned(EIGEN_PI, 1.0)});
  ASSERT_EQ(answered.size(), 3U);
  EXPECT_NEAR(std::abs(answered[1][5]), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(answered[1][6], std::sqrt(0.5), 1e-12);
  EXPECT_EQ(waypoints({turned(0.0, 1.0), turned(3.0, 1.0)}).size(), 2U);
}
}  // namespace
}  // namespace gpu_planning_scene::core
