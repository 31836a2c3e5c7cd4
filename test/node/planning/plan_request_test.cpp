// Requests of ~plan become queries of a planner. No ROS master is needed.

#include <gtest/gtest.h>

#include "model/model_testing.h"
#include "node/messages/requested_timing.h"
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

  PlanningQuery query() const
  {
    const Snapshot now = store_.snapshot();
    return queryFrom(request_, now, requestedStart(request_, now), {}, {}, {});
  }

  std::vector<std::string> warnings() const
  {
    const Snapshot now = store_.snapshot();
    return planWarnings(request_, now, requestedStart(request_, now));
  }

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
  const auto timing = [&] { return requestedTiming(request_, *robot(), 0.02, {MotionRule::Samples}, {}); };
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

TEST_F(BaseRequest, WithManyTurnsOrOtherValuesOutsideTheirLimitsHasWarnings)
{
  EXPECT_EQ(std::vector<std::string>(), warnings());
  request_.start[2] = 90.0;
  request_.goals = {0.0, 0.0, 0.5, 1.0, 0.0, -90.0};
  store_.updateState({{"slide", 7.0}});
  const std::vector<std::string> found = warnings();
  ASSERT_EQ(3U, found.size());
  EXPECT_EQ(0U, found[0].find("the start: joint 'slide' is 7")) << found[0];
  EXPECT_EQ(0U, found[1].find("the start: joint 'floor/theta' is 90 rad, more than one turn")) << found[1];
  EXPECT_EQ(0U, found[2].find("goal 1: joint 'floor/theta' is -90 rad, more than one turn")) << found[2];
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
  const auto warnings = [&]
  {
    const Snapshot now = store.snapshot();
    return planWarnings(request, now, requestedStart(request, now));
  };
  const std::vector<std::string> none;
  EXPECT_EQ(
      std::vector<std::string>{
          "named_start 'left' also sets variables outside the group 'mast', which have other values now: slide (-1 "
          "instead of 0.5); to keep them, give start_names and start"},
      warnings());
  store.updateState({{"slide", -1.0}});
  EXPECT_EQ(none, warnings());
  store.updateState({{"slide", 0.5}});
  request.group = "drive";
  EXPECT_EQ(none, warnings());
}
}  // namespace
}  // namespace gpu_planning_scene::core
