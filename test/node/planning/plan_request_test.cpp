// Requests of ~plan become queries of a planner. No ROS master is needed.

#include <gtest/gtest.h>

#include "model/model_testing.h"
#include "node/planning/plan_request.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A base that drives on a floor without limits. Translations are planned for within 1 m, unless a request has a
/// workspace.
class BaseRequest : public testing::Test
{
 protected:
  BaseRequest()
  {
    request_.group = "base";
    request_.start_names = request_.goal_names = {"floor/x", "floor/y", "floor/theta"};
    request_.start = {0.0, 0.0, 0.0};
    request_.goals = {5.0, -3.0, 0.5};
    store_.updateState({{"slide", 0.0}, {"turn", 0.0}});
  }

  PlanningQuery query() const { return queryFrom(request_, store_.snapshot(), {}, {}, {}); }

  static std::shared_ptr<const RobotModel> robot()
  {
    std::string srdf = sliderSrdf();
    srdf.insert(srdf.find("</robot>"),
                "<virtual_joint name='floor' type='planar' parent_frame='hall' child_link='rail'/>"
                "<group name='base'><joint name='floor'/></group>");
    return RobotModel::fromXml(sliderUrdf(), srdf, {});
  }

  SceneStore store_{PlanningScene(robot()), {}, {}};
  PlanMotion::Request request_;
};

TEST_F(BaseRequest, HasTheWorkspaceOfItsMessage)
{
  EXPECT_FALSE(query().workspace);
  request_.workspace_parameters.min_corner.x = request_.workspace_parameters.min_corner.y = -6.0;
  request_.workspace_parameters.max_corner.x = request_.workspace_parameters.max_corner.y = 7.0;
  for (const char* frame : {"", "hall", "/hall"})
  {
    request_.workspace_parameters.header.frame_id = frame;
    const PlanningQuery found = query();
    ASSERT_TRUE(found.workspace);
    EXPECT_EQ(Eigen::Vector3d(-6.0, -6.0, 0.0), found.workspace->min());
    EXPECT_EQ(Eigen::Vector3d(7.0, 7.0, 0.0), found.workspace->max());
  }
  request_.workspace_parameters.header.frame_id = "rail";
  EXPECT_NE(std::string::npos, errorOf([this] { query(); }).find("give them in the planning frame 'hall'"));
}

TEST_F(BaseRequest, ScalesVelocitiesAsMoveItDoes)
{
  PlanServiceOptions options;
  options.max_deviation = 0.02;
  const auto timing = [&] { return timingFrom(request_, *robot(), {MotionRule::Samples}, options); };
  EXPECT_FALSE(timing());
  request_.times = true;
  ASSERT_TRUE(timing());
  EXPECT_EQ(1.0, timing()->max_velocity_scaling_factor);
  EXPECT_EQ(1.0, timing()->max_acceleration_scaling_factor);
  EXPECT_EQ(0.02, timing()->max_deviation);
  EXPECT_EQ(MotionRule::Samples, timing()->motions.rule);
  request_.max_velocity_scaling_factor = 0.5;
  request_.max_acceleration_scaling_factor = 0.25;
  EXPECT_EQ(0.5, timing()->max_velocity_scaling_factor);
  EXPECT_EQ(0.25, timing()->max_acceleration_scaling_factor);
  for (const bool times : {true, false})
    for (const double wrong : {-0.1, 1.1, std::nan("")})
    {
      request_.times = times;
      request_.max_velocity_scaling_factor = wrong;
      request_.max_acceleration_scaling_factor = 0.0;
      EXPECT_EQ(0U, errorOf([&] { timing(); }).find("max_velocity_scaling_factor is "));
      std::swap(request_.max_velocity_scaling_factor, request_.max_acceleration_scaling_factor);
      EXPECT_EQ(0U, errorOf([&] { timing(); }).find("max_acceleration_scaling_factor is "));
    }
}

/// For example the state "ready" of two arms: it also sets the arm that is not planned for.
TEST(NamedStart, ThatReplacesKnownValuesOutsideTheGroupGivesAWarning)
{
  SceneStore store(PlanningScene(sliderRobot()), {}, {});
  store.updateState({{"slide", 0.5}, {"turn", 0.0}});
  PlanMotion::Request request;
  request.group = "mast";
  request.named_start = "left";  // slide = -1, turn = 0.8
  request.goal_names = {"turn"};
  request.goals = {0.1};
  const auto warning = [&]
  { return startBeyondGroup(request, store.snapshot(), queryFrom(request, store.snapshot(), {}, {}, {}).start); };
  EXPECT_EQ(
      "named_start 'left' also sets variables outside the group 'mast', which have other values now: slide (-1 instead "
      "of 0.5); to keep them, give start_names and start",
      warning());
  store.updateState({{"slide", -1.0}});
  EXPECT_EQ("", warning());
  store.updateState({{"slide", 0.5}});
  request.group = "drive";
  EXPECT_EQ("", warning());
}
}  // namespace
}  // namespace gpu_planning_scene::core
