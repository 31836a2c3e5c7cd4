// Straight motions of a base that drives only along its heading.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/math_constants.h"
#include "gpu_planning_scene/interpolation.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
std::shared_ptr<const RobotModel> driven(const std::string& motion_model)
{
  return robotOf(boxLink("body") + boxLink("arm") + jointXml("turn", "continuous", "body", "arm"),
                 "<virtual_joint name='drive' type='planar' parent_frame='world' child_link='body'/>"
                 "<joint_property joint_name='drive' property_name='motion_model' value='" +
                     motion_model + "'/>");
}

/// The message for a motion of the base, whose states are x, y and theta. The arm turns meanwhile.
std::string messageFor(const RobotModel& robot, std::vector<double> from, std::vector<double> to)
{
  from.push_back(0.0);
  to.push_back(1.0);
  return sidewaysMotion(robot, from.data(), to.data(), 1, "motion");
}

TEST(DifferentialDrive, TurnsOnTheSpotAndDrivesAlongItsHeading)
{
  const auto robot = driven("diff_drive");
  EXPECT_EQ("", messageFor(*robot, {1.0, 2.0, 0.0}, {1.0, 2.0, 3.0})) << "a turn";
  EXPECT_EQ("", messageFor(*robot, {1.0, 2.0, 0.0}, {3.0, 2.0, 0.0})) << "forwards";
  EXPECT_EQ("", messageFor(*robot, {1.0, 2.0, 0.0}, {0.0, 2.0, 0.0})) << "backwards";
  const double heading = std::atan2(-0.7, 0.3);
  EXPECT_EQ("", messageFor(*robot, {1.0, 2.0, heading}, {1.3, 1.3, heading + 2.0 * kPi})) << "to a computed point";
  EXPECT_EQ("", messageFor(*robot, {1.0, 2.0, 0.5}, {1.0, 2.0, 0.5})) << "the arm alone";
}

TEST(DifferentialDrive, ThatWouldMoveSidewaysOrOnAnArcIsNamed)
{
  const auto robot = driven("diff_drive");
  EXPECT_EQ(
      "motion 0: joint 'drive' moves 0.5 m sideways, which its motion_model diff_drive (SRDF) cannot do; give its "
      "way as turns on the spot and straight drives along its heading",
      messageFor(*robot, {0.0, 0.0, 0.0}, {1.0, 0.5, 0.0}));
  EXPECT_NE(std::string::npos, messageFor(*robot, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.25}).find("turns by 0.25 radians"));
  EXPECT_NE("", messageFor(*robot, {0.0, 0.0, 0.0}, {0.1, 0.0011, 0.0}));
  EXPECT_EQ("", messageFor(*robot, {0.0, 0.0, 1.57}, {0.0, 1.0, 1.57})) << "a heading with two decimals";
  EXPECT_EQ("", messageFor(*robot, {0.0, 0.0, 1.57}, {0.0, 20.0, 1.57}));
  EXPECT_NE("", messageFor(*robot, {0.0, 0.0, 0.0}, {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}));
  const std::vector<double> rows = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const std::vector<double> ends = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0};
  EXPECT_EQ(0u, sidewaysMotion(*robot, rows.data(), ends.data(), 2, "part").find("part 1: "));
}

TEST(DifferentialDrive, IsTheChoiceOfTheSrdf)
{
  EXPECT_EQ("", messageFor(*driven("holonomic"), {0.0, 0.0, 0.0}, {1.0, 0.5, 0.25}));
}
}  // namespace
}  // namespace gpu_planning_scene::core
