#include <filesystem>

#include <gtest/gtest.h>

#include "gpu_planning_scene/planning_file.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
std::vector<JointLimits> limitsOf(const std::string& text, std::vector<std::string>* warnings = nullptr)
{
  return jointLimitsFromText(text, "limits.yaml", warnings);
}

std::string faultOf(const std::string& text)
{
  return errorOf([&text] { limitsOf(text); });
}

TEST(PlanningFile, HasTheLimitsOfJointLimits)
{
  std::vector<std::string> warnings;
  const auto limits = limitsOf(
      "joint_limits:\n"
      "  elbow: {has_position_limits: true, min_position: -1, max_position: 0.5, has_velocity_limits: true, "
      "max_velocity: 2}\n"
      "  wrist: {has_velocity_limits: false, max_velocity: 0, max_acceleration: 3}\n"
      "  hand: {max_velocity: 1.5, has_acceleration_limits: false, max_acceleration: 0}\n"
      "  finger: {has_acceleration_limits: false, max_acceleration: 0}\n"
      "  base: {x: {min_position: -2, max_position: 4}}\n"
      "  base/y: {max_position: 5}\n"
      "default_velocity_scaling_factor: 0.1\n",
      &warnings);
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(5u, limits.size());
  EXPECT_EQ("elbow", limits[0].variable);
  EXPECT_EQ(-1.0, limits[0].min_position);
  EXPECT_EQ(0.5, limits[0].max_position);
  EXPECT_EQ(2.0, limits[0].max_velocity);
  EXPECT_FALSE(limits[0].max_acceleration);
  EXPECT_FALSE(limits[0].drops_velocity_limit);
  EXPECT_EQ("limits.yaml", limits[0].source);
  EXPECT_EQ("wrist", limits[1].variable);
  EXPECT_TRUE(limits[1].drops_velocity_limit);
  EXPECT_FALSE(limits[1].max_velocity);
  EXPECT_EQ(3.0, limits[1].max_acceleration);
  EXPECT_EQ("hand", limits[2].variable);
  EXPECT_EQ(1.5, limits[2].max_velocity);
  EXPECT_FALSE(limits[2].max_acceleration);
  EXPECT_EQ("base/x", limits[3].variable);
  EXPECT_EQ(4.0, limits[3].max_position);
  EXPECT_EQ("base/y", limits[4].variable);
  EXPECT_FALSE(limits[4].min_position);
}

TEST(PlanningFile, WithAWrongValueNamesItsLine)
{
  EXPECT_EQ("limits.yaml:2: 'low' is not a finite number", faultOf("joint_limits:\n  elbow: {min_position: low}"));
  EXPECT_EQ("limits.yaml:2: '.nan' is not a finite number", faultOf("joint_limits:\n  elbow: {max_position: .nan}"));
  EXPECT_EQ("limits.yaml:2: '.inf' is not a finite number", faultOf("joint_limits:\n  elbow: {max_velocity: .inf}"));
  EXPECT_EQ("limits.yaml:2: 'perhaps' is neither true nor false",
            faultOf("joint_limits:\n  elbow: {has_position_limits: perhaps}"));
  EXPECT_EQ("limits.yaml:2: expected 'key: value' pairs", faultOf("joint_limits:\n  elbow: 3"));
}

TEST(PlanningFile, WithAMisspeltLimitIsRefused)
{
  EXPECT_EQ("limits.yaml:1: unknown key 'joint_limit'; did you mean 'joint_limits'?",
            faultOf("joint_limit: {elbow: {max_position: 1}}"));
  for (const char* key : {"max_pos", "max", "upper", "position_max", "upper_limit"})
    EXPECT_EQ("limits.yaml:1: 'elbow': unknown key '" + std::string(key) +
                  "'; the limits of a position are min_position and max_position",
              faultOf("joint_limits: {elbow: {" + std::string(key) + ": 1}, wrist: {max_position: 1}}"));
  EXPECT_EQ("", faultOf("joint_limits: {elbow: {max_position: 1, has_soft_limits: true, soft_upper_limit: 1, "
                        "soft_lower_limit: 0, k_position: 20, k_velocity: 10, angle_wraparound: false}}"));
  EXPECT_NE("", faultOf("{joint_limits: {elbow: {max_position: 1}}, joints: {wrist: {max_position: 0.1}}}"));
  EXPECT_EQ("limits.yaml:1: 'elbow': unknown key 'max_positon'; did you mean 'max_position'?",
            faultOf("joint_limits: {elbow: {max_positon: 1}}"));
  EXPECT_EQ("limits.yaml:1: 'elbow': unknown key 'has_position_limit'; did you mean 'has_position_limits'?",
            faultOf("joint_limits: {elbow: {has_position_limit: true}}"));
  EXPECT_EQ("limits.yaml:1: 'elbow': unknown key 'max_acceleratoin'; did you mean 'max_acceleration'?",
            faultOf("joint_limits: {elbow: {max_acceleratoin: 1}}"));
  EXPECT_EQ("limits.yaml:1: 'elbow': unknown key 'max_vel'; the limit of velocity is max_velocity",
            faultOf("joint_limits: {elbow: {max_vel: 1}}"));
}

TEST(PlanningFile, WithLimitsInTheWrongPlaceIsRefused)
{
  EXPECT_EQ("limits.yaml:2: 'joint_limits' is in 'robot_description_planning'; it must be at the top of the file",
            faultOf("robot_description_planning:\n  joint_limits: {elbow: {max_position: 1}}"));
  EXPECT_EQ(
      "limits.yaml:2: 'elbow' has a position limit and is not in joint_limits; write joint_limits: {elbow: "
      "{max_position: ...}}",
      faultOf("joint_limits: {wrist: {max_position: 1}}\nelbow: {max_position: 1}"));
  EXPECT_EQ("", faultOf("cartesian_limits: {max_trans_vel: 1}\njoint_limits: {wrist: {max_position: 1}}"));
}

TEST(PlanningFile, ThatContradictsItselfGivesAWarning)
{
  std::vector<std::string> warnings;
  EXPECT_EQ(1u, limitsOf("joint_limits: {elbow: {has_position_limits: false, max_position: 1}}", &warnings).size());
  EXPECT_EQ(std::vector<std::string>{"limits.yaml: 'elbow' has position limits although has_position_limits is false; "
                                     "they are used, as in MoveIt, which does not read has_position_limits"},
            warnings);
  warnings.clear();
  EXPECT_TRUE(limitsOf("joint_limits: {elbow: {has_position_limits: true}}", &warnings).empty());
  EXPECT_EQ((std::vector<std::string>{
                "limits.yaml: 'elbow' has neither min_position nor max_position, so its limits are those of the URDF",
                "limits.yaml: no limits: joint_limits has no min_position, max_position, max_velocity or "
                "max_acceleration"}),
            warnings);
  warnings.clear();
  limitsOf("joint_limits: {elbow: {max_position: 1, has_acceleration_limits: true}}", &warnings);
  EXPECT_EQ(std::vector<std::string>{"limits.yaml: 'elbow' has no max_acceleration although has_acceleration_limits is "
                                     "true; it has no limit of acceleration"},
            warnings);
}

TEST(PlanningFile, WarnsOfParametersThatOnlyTheNodeApplies)
{
  std::vector<std::string> warnings;
  limitsOf("default_robot_padding: 0.02\njoint_limits: {elbow: {max_position: 1}}", &warnings);
  EXPECT_EQ(std::vector<std::string>{"limits.yaml:1: 'default_robot_padding' is not used here; only the node uses it"},
            warnings);
}

TEST(PlanningFile, OfAnotherProjectLimitsItsRobotAsMoveItDoes)
{
  const std::string folder = std::string(GPS_SHARED_DIR) + "/cases/";
  if (!std::filesystem::exists(folder + "limits.yaml"))
    GTEST_SKIP() << folder << "limits.yaml does not exist";
  RobotModelOptions options;
  const auto range = [&]
  {
    const auto robot = RobotModel::fromFiles(folder + "limits.urdf", "", options);
    const Variable& variable = robot->variables().at(static_cast<std::size_t>(robot->variableIndex("j2")));
    return std::make_pair(variable.lower, variable.upper);
  };
  EXPECT_EQ(std::make_pair(0.1, 0.8), range());
  options.joint_limits = readJointLimits(folder + "limits.yaml");
  EXPECT_EQ(std::make_pair(0.2, 0.5), range());
}
}  // namespace
}  // namespace gpu_planning_scene::core
