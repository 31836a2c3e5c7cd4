#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST(Srdf, CollisionEntriesArePairsOfLinkIndices)
{
  std::vector<std::string> warnings;
  const auto robot = robotOf(armUrdf(), R"(
    <disable_collisions link1="hand" link2="upper" reason="Never"/>
    <disable_collisions link1="base" link2="head"/>
    <enable_collisions link1="head" link2="hand"/>
    <disable_default_collisions link="fore"/>)",
                             &warnings);
  const SrdfCollisions& collisions = robot->srdfCollisions();
  EXPECT_TRUE(collisions.has_srdf);
  ASSERT_EQ(collisions.disabled.size(), 2u);
  EXPECT_EQ(collisions.disabled[0].first, robot->linkIndex("upper"));
  EXPECT_EQ(collisions.disabled[0].second, robot->linkIndex("hand"));
  EXPECT_EQ(collisions.disabled[0].reason, "Never");
  EXPECT_EQ(collisions.disabled[1].reason, "");
  ASSERT_EQ(collisions.enabled.size(), 1u);
  EXPECT_EQ(collisions.enabled[0].first, robot->linkIndex("hand"));
  EXPECT_EQ(collisions.disabled_by_default, std::vector<int>{robot->linkIndex("fore")});
  EXPECT_TRUE(warnings.empty()) << warnings[0];
}

TEST(Srdf, AUrdfInItsPlaceIsRefused)
{
  const std::string message = srdfError("\n<link name='base'/>");
  EXPECT_EQ(message.find("test.srdf:2: <link> is an element of a URDF, and an SRDF is needed here"), 0u) << message;
}

TEST(Srdf, XacroIsRefusedWithTheCommandToRun)
{
  const std::string message = srdfError("<group name='arm'/>\n<xacro:include filename='x'/>");
  EXPECT_EQ(
      message.find("test.srdf:2: <xacro:include> is xacro, which must be expanded first: xacro FILE > expanded.srdf, "
                   "or for the launch file srdf_command:=\"xacro FILE\" instead of srdf:=FILE"),
      0u)
      << message;
  EXPECT_EQ(srdfError("<group name='${name}_arm'/>").find("test.srdf:1: name=\"${name}_arm\" is xacro"), 0u);
}

TEST(Srdf, UnknownLinksInCollisionEntriesAreWarnings)
{
  std::vector<std::string> warnings;
  const auto robot = robotOf(armUrdf(), R"(
    <disable_collisions link1="hand" link2="x" reason="Never"/>
    <disable_collisions link1="y" link2="hand" reason="Never"/>
    <enable_collisions link1="z" link2="hand"/>
    <disable_default_collisions link="w"/>
    <disable_collisions link1="hand" link2="hand"/>
    <passive_joint name="v"/>)",
                             &warnings);
  EXPECT_TRUE(robot->srdfCollisions().disabled.empty());
  EXPECT_TRUE(robot->srdfCollisions().enabled.empty());
  EXPECT_TRUE(robot->srdfCollisions().disabled_by_default.empty());
  ASSERT_EQ(warnings.size(), 5u);
  for (const char* text :
       {"test.srdf:2: this and 1 more disable_collisions are ignored, because the robot does not have x, y",
        "test.srdf:4: the robot does not have z", "test.srdf:5: link 'w'",
        "test.srdf:6: link 'hand' is paired with itself", "test.srdf:7: passive joint 'v'"})
  {
    const auto mentions = [&](const std::string& warning) { return warning.find(text) != std::string::npos; };
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), mentions)) << text;
  }
}

TEST(Srdf, AVirtualJointMovesTheRootInThePlanningFrame)
{
  const auto robot =
      robotOf(armUrdf(), R"(<virtual_joint name="v" type="floating" parent_frame="odom" child_link="base"/>)");
  EXPECT_EQ(robot->planningFrame(), "odom");
  EXPECT_EQ(robot->joints()[0].name, "v");
  EXPECT_EQ(robot->joints()[0].parent_link, -1);
  EXPECT_EQ(robot->joints()[0].child_link, 0);
  EXPECT_EQ(robot->links()[0].parent_joint, 0);
  EXPECT_EQ(robot->variableIndex("v/trans_x"), 0);
  EXPECT_EQ(robot->variableIndex("arm_1"), 7);

  std::vector<double> state = robot->defaultState();
  state[1] = 5.0;
  std::vector<Eigen::Isometry3d> poses(robot->links().size());
  robot->linkPoses(state.data(), poses.data());
  for (const Eigen::Isometry3d& pose : poses)
    EXPECT_EQ(pose.translation(), Eigen::Vector3d(0, 5, 0));
}

TEST(Srdf, APlanarVirtualJointMovesInTheGroundPlane)
{
  const auto robot =
      robotOf(armUrdf(), R"(<virtual_joint name="v" type="planar" parent_frame="odom" child_link="base"/>)");
  std::vector<double> state = robot->defaultState();
  state[0] = 1.0;
  state[1] = 2.0;
  state[2] = std::acos(-1.0) / 2.0;
  std::vector<Eigen::Isometry3d> poses(robot->links().size());
  robot->linkPoses(state.data(), poses.data());
  EXPECT_TRUE((poses[0] * Eigen::Vector3d(1, 0, 0.5)).isApprox(Eigen::Vector3d(1, 3, 0.5), 1e-15));
}

TEST(Srdf, AFixedVirtualJointOnlyNamesThePlanningFrame)
{
  const auto robot =
      robotOf(armUrdf(), R"(<virtual_joint name="v" type="fixed" parent_frame="world" child_link="base"/>)");
  EXPECT_EQ(robot->planningFrame(), "world");
  EXPECT_EQ(robot->variables().size(), robotOf(armUrdf())->variables().size());
}

TEST(Srdf, VirtualJointsThatDoNotFitAreIgnoredWithAWarning)
{
  std::vector<std::string> warnings;
  const auto robot = robotOf(armUrdf(), R"(
    <virtual_joint name="v" type="floating" parent_frame="odom" child_link="hand"/>
    <virtual_joint name="w" type="fixed" parent_frame="map" child_link="base"/>
    <virtual_joint name="x" type="planar" parent_frame="odom" child_link="base"/>
    <group name="g"><joint name="v"/><joint name="pan"/></group>)",
                             &warnings);
  EXPECT_EQ(robot->planningFrame(), "map");
  EXPECT_EQ(robot->variableIndex("v/trans_x"), -1);
  EXPECT_EQ(robot->group("g").joints.size(), 1u);
  ASSERT_EQ(warnings.size(), 3u);
  EXPECT_NE(warnings[0].find("test.srdf:2: virtual joint 'v'"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("test.srdf:4: virtual joint 'x'"), std::string::npos) << warnings[1];
  EXPECT_NE(warnings[2].find("test.srdf:5: group 'g'"), std::string::npos) << warnings[2];
}

TEST(Srdf, BadVirtualJointsAreErrors)
{
  EXPECT_NE(srdfError(R"(<virtual_joint name="v" type="ball" parent_frame="odom" child_link="base"/>)").find("'ball'"),
            std::string::npos);
  EXPECT_NE(srdfError(R"(<virtual_joint name="v" type="fixed" child_link="base"/>)").find("'parent_frame'"),
            std::string::npos);
  EXPECT_NE(
      srdfError(R"(<virtual_joint name="pan" type="fixed" parent_frame="odom" child_link="base"/>)").find("'pan'"),
      std::string::npos);
}

TEST(Srdf, PassiveJointsAreMarked)
{
  const auto robot = robotOf(armUrdf(), R"(<passive_joint name="arm_2"/>)");
  EXPECT_TRUE(robot->joints()[robot->jointIndex("arm_2")].passive);
  EXPECT_FALSE(robot->joints()[robot->jointIndex("arm_1")].passive);
}

TEST(Srdf, MalformedXmlIsAnErrorWithItsLine)
{
  EXPECT_NE(srdfError("\n<group name=\"g\">\n</grop>").find("test.srdf:"), std::string::npos);
  EXPECT_NE(errorOf([] { RobotModel::fromXml("<robot name=\"r\"><link name=\"a\"/></robot>", "<srdf/>", {}); })
                .find("robot_description_semantic:1: the root element is <srdf>"),
            std::string::npos);
}

TEST(Srdf, ElementsWithoutANeededAttributeAreLeftOutWithAWarning)
{
  std::vector<std::string> warnings;
  const auto robot = robotOf(armUrdf(), R"(
    <disable_collisions link1="base"/>
    <passive_joint/>
    <disable_default_collisions/>
    <group name="g"><joint name="pan"/></group>
    <group_state name="no_group"><joint name="pan" value="1"/></group_state>
    <group_state group="g"><joint name="pan" value="1"/></group_state>
    <group_state name="s" group="g"><joint value="1"/><joint name="pan"/></group_state>)",
                             &warnings);
  const std::vector<std::string> expected = {
      "test.srdf:6: <group_state name=\"no_group\"> lacks the attribute 'group'; it is left out",
      "test.srdf:7: <group_state> lacks the attribute 'name'; it is left out",
      "test.srdf:8: <joint> lacks the attribute 'name'; it is left out",
      "test.srdf:8: <joint name=\"pan\"> lacks the attribute 'value'; it is left out",
      "test.srdf:3: <passive_joint> lacks the attribute 'name'; it is left out",
      "test.srdf:2: <disable_collisions> lacks the attribute 'link2'; it is left out",
      "test.srdf:4: <disable_default_collisions> lacks the attribute 'link'; it is left out"};
  EXPECT_EQ(expected, warnings);
  ASSERT_EQ(1u, robot->namedStates().size());
  EXPECT_EQ("s", robot->namedStates()[0].name);
}

TEST(Srdf, AnIncompleteEntryThatAsksForAnotherCheckIsAnError)
{
  EXPECT_EQ("test.srdf:1: <enable_collisions> lacks the attribute 'link2'",
            srdfError("<enable_collisions link1=\"base\"/>"));
}

TEST(Srdf, MisspeltElementsAreErrorsIfPairsWouldGoUnchecked)
{
  for (const auto& [srdf, wrong, meant] : std::vector<std::array<std::string, 3>>{
           {"<enable_collision link1='base' link2='hand'/>", "enable_collision", "enable_collisions"},
           {"<virtual-joint/>", "virtual-joint", "virtual_joint"},
           {"<groups name='g'/>", "groups", "group"},
           {"<group name='g'><chian/></group>", "chian", "chain"},
           {"<group name='g'><joints/></group>", "joints", "joint"}})
    EXPECT_EQ("test.srdf:1: unknown element <" + wrong + ">; did you mean <" + meant + ">?", srdfError(srdf));
}

TEST(Srdf, OtherMisspeltElementsAreWarningsAndForeignOnesPass)
{
  std::vector<std::string> warnings;
  robotOf(armUrdf(), R"(<disable_collision link1="base" link2="hand"/>
<group_states name="s" group="g"/>
<tool_frame/><group name="g"><joint name="pan"/><passive_joint name="pan"/><note/></group>)",
          &warnings);
  EXPECT_EQ((std::vector<std::string>{
                "test.srdf:1: unknown element <disable_collision>; did you mean <disable_collisions>? It is left out",
                "test.srdf:2: unknown element <group_states>; did you mean <group_state>? It is left out"}),
            warnings);
}

TEST(Srdf, TheMotionModelOfAPlanarJointIsRead)
{
  const auto srdf = [](const std::string& joint, const std::string& model)
  {
    return "<virtual_joint name='drive' type='planar' parent_frame='world' child_link='base'/>\n<joint_property "
           "joint_name='" +
           joint + "' property_name='motion_model' value='" + model + "'/>" +
           "<joint_property joint_name='drive' property_name='angular_distance_weight' value='0.5'/>";
  };
  const auto is_diff_drive = [&](const std::string& model)
  {
    const auto robot = robotOf(armUrdf(), srdf("drive", model));
    return robot->joints()[static_cast<std::size_t>(robot->jointIndex("drive"))].diff_drive;
  };
  EXPECT_TRUE(is_diff_drive("diff_drive"));
  EXPECT_FALSE(is_diff_drive("holonomic"));
  EXPECT_EQ("test.srdf:2: the motion_model of joint 'drive' is 'diffdrive'; it must be holonomic or diff_drive",
            srdfError(srdf("drive", "diffdrive")));
  std::vector<std::string> warnings;
  robotOf(armUrdf(), srdf("pan", "diff_drive"), &warnings);
  robotOf(armUrdf(), srdf("dive", "diff_drive"), &warnings);
  robotOf(armUrdf(), "<joint_property joint_name='drive' property_name='motion_model'/>", &warnings);
  EXPECT_EQ((std::vector<std::string>{
                "test.srdf:2: the motion_model of joint 'pan' has no effect: the joint is not planar",
                "test.srdf:2: the motion_model of joint 'dive' has no effect: the joint is not in the robot",
                "test.srdf:1: <joint_property> lacks the attribute 'value'; it is left out"}),
            warnings);
}

TEST(Srdf, TheSrdfOfAnotherRobotGivesAWarning)
{
  std::vector<std::string> warnings;
  RobotModel::fromXml("<robot name=\"r\"><link name=\"a\"/></robot>", "<robot name=\"s\"/>", {}, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("'s'"), std::string::npos) << warnings[0];
}

TEST(Srdf, WithoutOneThereAreNoGroups)
{
  const auto robot = robotOf(armUrdf());
  EXPECT_FALSE(robot->srdfCollisions().has_srdf);
  EXPECT_TRUE(robot->groups().empty());
  EXPECT_EQ(robot->planningFrame(), "base");
}
const char* const kGroups = R"(<group name="arm"><chain base_link="base" tip_link="hand"/></group>
    <group name="grip"><joint name="left"/><joint name="right"/></group>)";

TEST(SrdfStates, HaveTheValuesOfTheirGroupsJoints)
{
  std::vector<std::string> warnings;
  const auto robot = robotOf(armUrdf(), kGroups + std::string(R"(
    <group_state name="ready" group="arm"><joint name="arm_2" value="0.5"/><joint name="arm_1" value=" -1e-1 "/>
      <joint name="hand_fix" value="3"/></group_state>
    <group_state name="open" group="grip"><joint name="left" value="1"/><joint name="right" value="1"/></group_state>)"),
                             &warnings);
  EXPECT_TRUE(warnings.empty()) << warnings[0];
  const NamedState ready = robot->namedState("ready");
  EXPECT_EQ(ready.group, "arm");
  EXPECT_EQ(ready.variables, (std::vector<int>{robot->variableIndex("arm_2"), robot->variableIndex("arm_1")}));
  EXPECT_EQ(ready.values, (std::vector<double>{0.5, -0.1}));
  EXPECT_EQ(robot->namedState("grip/open").variables, std::vector<int>{robot->variableIndex("left")});
  EXPECT_EQ(errorOf([&] { robot->namedState("home"); }),
            "the SRDF has no state 'home'; its states: arm/ready, grip/open");
  EXPECT_EQ(errorOf([] { robotOf(armUrdf())->namedState("home"); }),
            "there is no state 'home', because the robot has no SRDF, which names states");
  EXPECT_EQ(errorOf([] { robotOf(armUrdf(), kGroups)->namedState("home"); }),
            "the SRDF has no state 'home'; it names no states");
}

TEST(SrdfStates, OfOneNameAreMergedUnlessTheyDisagree)
{
  const auto robot = robotOf(armUrdf(), kGroups + std::string(R"(
    <group_state name="home" group="arm"><joint name="arm_1" value="0.5"/></group_state>
    <group_state name="home" group="grip"><joint name="left" value="1"/></group_state>
    <group name="all"><group name="arm"/><group name="grip"/></group>
    <group_state name="twice" group="arm"><joint name="arm_1" value="0.5"/></group_state>
    <group_state name="twice" group="all"><joint name="arm_1" value="0.6"/></group_state>
    <group_state name="again" group="arm"><joint name="arm_1" value="0.5"/></group_state>
    <group_state name="again" group="arm"><joint name="arm_1" value="0.6"/></group_state>)"));
  EXPECT_EQ(robot->namedState("home").variables.size(), 2u);
  EXPECT_EQ(robot->namedState("arm/home").variables.size(), 1u);
  EXPECT_EQ(errorOf([&] { robot->namedState("twice"); }),
            "the states 'twice' of the SRDF give arm_1 different values; write GROUP/NAME: arm/twice or all/twice");
  EXPECT_EQ(robot->namedState("all/twice").values, std::vector<double>{0.6});
  EXPECT_EQ(errorOf([&] { robot->namedState("arm/again"); }),
            "the SRDF has the state 'arm/again' more than once, with different values; remove all but one");
}

TEST(SrdfStates, WithFaultsGiveWarnings)
{
  std::vector<std::string> warnings;
  const auto robot = robotOf(armUrdf(), kGroups + std::string(R"(
    <group_state name="a" group="legs"/>
    <group_state name="b" group="arm"><joint name="arm_9" value="0.5"/><joint name="arm_1" value="0.5 1"/><joint name="left" value="1"/>
      <joint name="arm_2" value="0.5x"/></group_state>)"),
                             &warnings);
  EXPECT_EQ(
      "the state 'b' of the SRDF sets no variable: each of its joints is fixed, follows another joint, or has a value "
      "that was ignored with a warning; name another state",
      errorOf([&] { robot->namedState("b"); }));
  const std::vector<std::string> expected = {
      "test.srdf:3: state 'a' is ignored: its group 'legs' does not exist",
      "test.srdf:4: state 'b': joint 'arm_9' is not in the robot, the entry is ignored",
      "test.srdf:4: state 'b': joint 'arm_1' needs 1 finite numbers, not '0.5 1'; the entry is ignored",
      "test.srdf:4: state 'b': joint 'left' is not in its group 'arm', the entry is ignored, as in MoveIt",
      "test.srdf:5: state 'b': joint 'arm_2' needs 1 finite numbers, not '0.5x'; the entry is ignored"};
  EXPECT_EQ(expected, warnings);
}

TEST(Srdf, OfAnotherRobotIsAnError)
{
  RobotModelOptions options;
  options.srdf_name = "test.srdf";
  EXPECT_EQ(
      "test.srdf:1: the SRDF is for robot 'other', but the URDF is of robot 'arm', which has none of the links in the "
      "disable_collisions entries; give the SRDF of this robot",
      errorOf(
          [&]
          {
            RobotModel::fromXml("<robot name='arm'>" + armUrdf() + "</robot>",
                                "<robot name='other'><disable_collisions link1='a' link2='b'/></robot>", options);
          }));
}
}  // namespace
}  // namespace gpu_planning_scene::core
