// The limits of the joints come from robot_description_planning/joint_limits, as in MoveIt. The node has the limits of
// strict_planning.yaml. Other tests make the scene of a node with parameters of its own in the namespace /limits.

#include <gpu_planning_scene/GetReport.h>
#include <gpu_planning_scene/PlanMotion.h>

#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "node/node_client.h"
#include "node/parameters/node_parameters.h"
#include "node/parameters/setup.h"

namespace gpu_planning_scene::core
{
namespace
{
class JointLimitsOfTheNode : public RunningNode
{
};

TEST_F(JointLimitsOfTheNode, AreReportedWithTheirSource)
{
  const auto report = call<GetReport>("get_report", GetReport::Request());
  const std::string line = "limits from parameter /robot_description_planning/joint_limits: turn (-1.5 to 1.25)";
  EXPECT_EQ(1, std::count(report.lines.begin(), report.lines.end(), line));
}

TEST_F(JointLimitsOfTheNode, BoundPlans)
{
  PlanMotion::Request request;
  request.group = "drive";
  request.start_names = request.goal_names = {"slide", "turn"};
  request.start = {0.0, 0.0};
  request.goals = {0.0, 2.0};  // within the URDF's limits
  const auto refused = call<PlanMotion>("plan", request);
  EXPECT_EQ(PlanMotion::Response::OUT_OF_BOUNDS, refused.status);
  EXPECT_NE(std::string::npos, refused.message.find("joint 'turn' is 2, outside its limits -1.5 to 1.25"))
      << refused.message;
  request.goals = {0.0, 1.2};
  const auto solved = call<PlanMotion>("plan", request);
  EXPECT_TRUE(solved.success) << solved.message;
}

TEST_F(JointLimitsOfTheNode, AreThoseBeyondWhichAStateGivesAWarning)
{
  const auto checked = call<CheckStates>("check_states", stateRequest({0.0, 1.3}));
  EXPECT_TRUE(checked.success);
  EXPECT_NE(std::string::npos, checked.message.find("joint 'turn' is 1.3, outside its limits -1.5 to 1.25"))
      << checked.message;
}

/// Parameters in the namespace /limits, with the robot of the node.
class LimitParameters : public testing::Test
{
 public:
  LimitParameters()
  {
    node.setParam("robot_description", ros::NodeHandle().param<std::string>("/robot_description", ""));
    node.setParam("robot_description_semantic", "");
  }
  ~LimitParameters() override { ros::NodeHandle().deleteParam("/limits"); }

  PlanningScene load()
  {
    warnings.clear();
    return sceneFromParameters(node, own, defaults, &warnings);
  }

  /// "LOWER to UPPER, SOURCE" of the joint slide.
  std::string slide()
  {
    const Variable variable = load().robot->variables().at(0);
    return std::to_string(variable.lower) + " to " + std::to_string(variable.upper) + ", " + variable.limits_source;
  }

  std::string fault()
  {
    return errorOf([this] { load(); });
  }

  ros::NodeHandle node{"/limits"};
  ros::NodeHandle own{"/limits/node"};
  const std::string limits = "/limits/robot_description_planning/joint_limits/";
  SceneDefaults defaults;
  std::vector<std::string> warnings;
};

TEST_F(LimitParameters, ReplaceThoseOfTheUrdf)
{
  EXPECT_EQ("-2.000000 to 2.000000, ", slide());
  node.setParam(limits + "slide/max_position", 1);
  EXPECT_EQ("-2.000000 to 1.000000, parameter /limits/robot_description_planning/joint_limits", slide());
  node.setParam(limits + "slide/min_position", -0.5);
  EXPECT_EQ("-0.500000 to 1.000000, parameter /limits/robot_description_planning/joint_limits", slide());
  EXPECT_TRUE(warnings.empty());
}

TEST_F(LimitParameters, AreThoseOfTheMoveGroupThatTheNodeFollows)
{
  node.setParam(limits + "slide/max_position", 1.0);
  node.setParam("arm/robot_description", "MoveIt reads it");
  node.setParam("arm/robot_description_planning/joint_limits/slide/max_position", 0.25);
  own.setParam("monitor", "/limits/arm/move_group");
  EXPECT_EQ("-2.000000 to 0.250000, parameter /limits/arm/robot_description_planning/joint_limits", slide());
  own.setParam("monitor", "/limits/move_group");
  EXPECT_EQ("-2.000000 to 1.000000, parameter /limits/robot_description_planning/joint_limits", slide());
}

TEST_F(LimitParameters, OfTheWrongTypeAreNamed)
{
  const std::string slide = "parameter /limits/robot_description_planning/joint_limits/slide";
  node.setParam(limits + "slide/max_position", "1");
  EXPECT_EQ(slide + "/max_position is not a number", fault());
  node.setParam(limits + "slide/max_position", 1.0);
  node.setParam(limits + "slide/has_position_limits", 1);
  EXPECT_EQ(slide + "/has_position_limits is not true or false", fault());
  node.deleteParam(limits + "slide/has_position_limits");
  node.setParam(limits + "slide/min_positon", 1.0);
  EXPECT_EQ(slide + "/min_positon: unknown key; did you mean 'min_position'?", fault());
  node.setParam(limits + "slide", 3);
  EXPECT_EQ(slide + " is not a map; write {JOINT: {min_position: NUMBER, max_position: NUMBER}}", fault());
  node.deleteParam("robot_description_planning/joint_limits");
  node.setParam("robot_description_planning/joint_limit/slide/min_position", 1.0);
  EXPECT_EQ("parameter /limits/robot_description_planning/joint_limit: unknown key; did you mean 'joint_limits'?",
            fault());
}

TEST_F(LimitParameters, OfUnknownJointsGiveAWarning)
{
  node.setParam(limits + "sled/max_position", 1.0);
  load();
  EXPECT_EQ(std::vector<std::string>{"parameter /limits/robot_description_planning/joint_limits: position limits are "
                                     "not used, because the robot does not have the joint: sled"},
            warnings);
}

TEST_F(LimitParameters, ThatDifferMakeAnotherSetup)
{
  const auto setup = [this] { return setupFromParameters(node, *load().robot, defaults); };
  const std::uint64_t before = setup();
  EXPECT_EQ(before, setup());
  node.setParam(limits + "slide/max_position", 1.0);
  EXPECT_NE(before, setup());
}
}  // namespace
}  // namespace gpu_planning_scene::core
