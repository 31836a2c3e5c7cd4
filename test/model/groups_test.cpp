#include <gtest/gtest.h>

#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
using Names = std::vector<std::string>;

TEST(Groups, JointsLinksChainsAndSubgroupsAddJoints)
{
  const auto robot = robotOf(armUrdf(), R"(
    <group name="all"><group name="arm"/><group name="gripper"/></group>
    <group name="arm"><chain base_link="base" tip_link="hand"/></group>
    <group name="gripper"><link name="finger_left"/><link name="finger_right"/></group>
    <group name="one"><joint name="arm_2"/></group>)");
  EXPECT_EQ(jointNames(*robot, robot->group("arm").joints), (Names{"arm_1", "arm_2", "hand_fix"}));
  EXPECT_EQ(jointNames(*robot, robot->group("gripper").joints), (Names{"left", "right"}));
  EXPECT_EQ(jointNames(*robot, robot->group("all").joints), (Names{"arm_1", "arm_2", "hand_fix", "left", "right"}));
  EXPECT_EQ(jointNames(*robot, robot->group("one").joints), (Names{"arm_2"}));
  EXPECT_EQ(robot->groups().size(), 4u);
  EXPECT_EQ(robot->groups()[0].name, "all");
}

TEST(Groups, VariablesAreThoseOfActiveJoints)
{
  const auto robot = robotOf(armUrdf(), R"(
    <group name="arm"><chain base_link="base" tip_link="hand"/></group>
    <group name="gripper"><joint name="right"/><joint name="left"/></group>)");
  EXPECT_EQ(robot->group("arm").variables, (std::vector<int>{0, 1}));
  EXPECT_EQ(robot->group("gripper").variables, (std::vector<int>{2}));
}

TEST(Groups, AGroupMovesAllLinksBelowItsActiveJoints)
{
  const auto robot = robotOf(armUrdf(), R"(
    <group name="elbow"><joint name="arm_2"/></group>
    <group name="pan"><joint name="pan"/></group>
    <group name="mount"><joint name="hand_fix"/></group>)");
  EXPECT_EQ(linkNames(*robot, robot->group("elbow").moved_links),
            (Names{"fore", "hand", "finger_left", "finger_right"}));
  EXPECT_EQ(linkNames(*robot, robot->group("pan").moved_links), (Names{"head"}));
  EXPECT_TRUE(robot->group("mount").moved_links.empty());
}

TEST(Groups, ALeaderMovesTheLinksOfItsMimicsToo)
{
  const auto robot = robotOf(armUrdf(), R"(
    <group name="leader"><joint name="left"/></group>
    <group name="mimic"><joint name="right"/></group>)");
  EXPECT_EQ(linkNames(*robot, robot->group("leader").moved_links), (Names{"finger_left", "finger_right"}));
  EXPECT_TRUE(robot->group("mimic").moved_links.empty()) << "the group does not own the leader's variable";
}

TEST(Groups, AChainBetweenTwoBranchesTakesBothUpToTheirMeetingPoint)
{
  const auto robot = robotOf(armUrdf(), R"(
    <group name="over_root"><chain base_link="head" tip_link="fore"/></group>
    <group name="fingers"><chain base_link="finger_left" tip_link="finger_right"/></group>
    <group name="upwards"><chain base_link="hand" tip_link="upper"/></group>)");
  EXPECT_EQ(jointNames(*robot, robot->group("over_root").joints), (Names{"arm_1", "arm_2", "pan"}));
  // As MoveIt has it, the joint above the meeting point is included.
  EXPECT_EQ(jointNames(*robot, robot->group("fingers").joints), (Names{"hand_fix", "left", "right"}));
  EXPECT_EQ(jointNames(*robot, robot->group("upwards").joints), (Names{"arm_1", "arm_2", "hand_fix"}));
}

TEST(Groups, AVirtualJointCanBelongToAGroup)
{
  const auto robot = robotOf(armUrdf(), R"(
    <virtual_joint name="v" type="planar" parent_frame="odom" child_link="base"/>
    <group name="base"><joint name="v"/></group>
    <group name="base_by_link"><link name="base"/></group>)");
  EXPECT_EQ(robot->group("base").variables, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(robot->group("base").moved_links.size(), robot->links().size());
  EXPECT_EQ(robot->group("base_by_link").joints, robot->group("base").joints);
}

/// Expects that the SRDF gives these warnings, and returns the robot.
std::shared_ptr<const RobotModel> robotWith(const std::string& srdf, const Names& expected)
{
  Names warnings;
  auto robot = robotOf(armUrdf(), srdf, &warnings);
  EXPECT_EQ(expected, warnings);
  return robot;
}

TEST(Groups, UnknownNamesAreLeftOutWithAWarning)
{
  const std::string not_there = "', which the robot does not have; the entry is left out";
  const auto robot = robotWith(
      R"(
    <group name="g">
      <joint name="x"/><joint name="pan"/>
      <link name="y"/>
      <chain base_link="z" tip_link="hand"/>
      <chain base_link="base" tip_link="w"/>
    </group>)",
      {"test.srdf:3: group 'g' names joint 'x" + not_there, "test.srdf:4: group 'g' names link 'y" + not_there,
       "test.srdf:5: group 'g' names link 'z" + not_there, "test.srdf:6: group 'g' names link 'w" + not_there});
  EXPECT_EQ((Names{"pan"}), jointNames(*robot, robot->group("g").joints));
}

TEST(Groups, GroupsWithoutASubgroupAndGroupsInCirclesAreLeftOut)
{
  const auto robot = robotWith(
      R"(<group name="good"><joint name="pan"/></group>
         <group name="g"><group name="good"/><group name="h"/></group>
         <group name="over_g"><joint name="pan"/><group name="g"/></group>
         <group name="self"><group name="self"/></group>
         <group name="a"><group name="b"/></group>
         <group name="b"><group name="a"/></group>
         <group_state name="s" group="a"/>)",
      {"test.srdf:2: group 'g' is left out: its subgroup 'h' does not exist",
       "test.srdf:3: group 'over_g' is left out: its subgroup 'g' is left out too, or contains this group",
       "test.srdf:4: group 'self' is left out: its subgroup 'self' is left out too, or contains this group",
       "test.srdf:5: group 'a' is left out: its subgroup 'b' is left out too, or contains this group",
       "test.srdf:6: group 'b' is left out: its subgroup 'a' is left out too, or contains this group",
       "test.srdf:7: state 's' is ignored: its group 'a' does not exist"});
  ASSERT_EQ(1u, robot->groups().size());
  EXPECT_EQ("good", robot->groups()[0].name);
}

TEST(Groups, ASharedSubgroupIsNoLoop)
{
  const auto robot = robotOf(armUrdf(), R"(
    <group name="top"><group name="a"/><group name="b"/></group>
    <group name="a"><group name="c"/></group><group name="b"><group name="c"/></group>
    <group name="c"><joint name="pan"/></group>)");
  EXPECT_EQ(robot->group("top").variables, robot->group("c").variables);
}

TEST(Groups, TheErrorForAMissingNameAsksForOneAndListsTheGroups)
{
  const auto robot = robotOf(armUrdf(), "<group name=\"g\"><joint name=\"pan\"/></group>");
  EXPECT_EQ("give group, the name of a planning group of robot '" + robot->name() + "'; its groups: g",
            errorOf([&] { robot->group(""); }));
  EXPECT_EQ("robot '" + robot->name() + "' has no group 'h'; its groups: g", errorOf([&] { robot->group("h"); }));
}

TEST(Groups, ElementsWithoutANeededAttributeAreLeftOutWithAWarning)
{
  const auto robot = robotWith(
      R"(<group/>
         <group name="g"><chain base_link="base"/><joint name="pan"/>
           <joint/><group/>
         </group>)",
      {"test.srdf:1: <group> lacks the attribute 'name'; it is left out",
       "test.srdf:3: <joint> lacks the attribute 'name'; it is left out",
       "test.srdf:3: <group> lacks the attribute 'name'; it is left out",
       "test.srdf:2: <chain> lacks the attribute 'tip_link'; it is left out"});
  EXPECT_EQ((Names{"pan"}), jointNames(*robot, robot->group("g").joints));
}

TEST(Groups, NamesAreTrimmedAsInMoveIt)
{
  const auto robot = robotWith(R"(<group name=" g "><joint name="pan "/></group>)", {});
  EXPECT_EQ((Names{"pan"}), jointNames(*robot, robot->group("g").joints));
}

TEST(Groups, OddGroupsGiveWarnings)
{
  std::vector<std::string> warnings;
  const auto robot = robotOf(armUrdf(), R"(
    <group name="g"><joint name="pan"/></group>
    <group name="g"><joint name="arm_1"/></group>
    <group name="still"><joint name="hand_fix"/></group>)",
                             &warnings);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("test.srdf:3: group 'g' is defined twice"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("test.srdf:4: group 'still' has no joint that can move"), std::string::npos);
  EXPECT_EQ(jointNames(*robot, robot->group("g").joints), (Names{"pan"}));
}

TEST(Groups, AnUnknownGroupIsAnErrorThatListsTheGroups)
{
  const auto robot = robotOf(
      armUrdf(), "<group name=\"a\"><joint name=\"pan\"/></group><group name=\"b\"><joint name=\"left\"/></group>");
  const std::string unknown = errorOf([&] { robot->group("c"); });
  EXPECT_NE(unknown.find("'c'"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("a, b"), std::string::npos) << unknown;
  EXPECT_NE(errorOf([] { robotOf(armUrdf())->group("c"); }).find("SRDF"), std::string::npos);
}
}  // namespace
}  // namespace gpu_planning_scene::core
