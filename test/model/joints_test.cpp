#include <gtest/gtest.h>

#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kPi = 3.14159265358979323846;

std::string twoLinks()
{
  return boxLink("a") + boxLink("b");
}

const Variable& variable(const RobotModel& robot, const std::string& name)
{
  return robot.variables().at(static_cast<std::size_t>(robot.variableIndex(name)));
}

std::vector<std::string> variableNames(const RobotModel& robot)
{
  std::vector<std::string> names;
  for (const Variable& variable : robot.variables())
    names.push_back(variable.name);
  return names;
}

TEST(Joints, RevoluteAndPrismaticJointsHaveTheirLimits)
{
  for (const char* type : {"revolute", "prismatic"})
  {
    const auto robot = robotOf(twoLinks() + jointXml("j", type, "a", "b", kLimits));
    EXPECT_TRUE(variable(*robot, "j").bounded);
    EXPECT_EQ(variable(*robot, "j").lower, -1.0);
    EXPECT_EQ(variable(*robot, "j").upper, 2.0);
  }
}

TEST(Joints, ARevoluteJointWithZeroRangeIsBoundToZero)
{
  const auto robot = robotOf(twoLinks() + jointXml("j", "revolute", "a", "b", R"(<limit effort="1" velocity="1"/>)"));
  EXPECT_TRUE(variable(*robot, "j").bounded);
  EXPECT_EQ(variable(*robot, "j").lower, 0.0);
  EXPECT_EQ(variable(*robot, "j").upper, 0.0);
}

TEST(Joints, AContinuousJointIsUnboundedWhateverItsLimits)
{
  const auto robot = robotOf(twoLinks() + jointXml("j", "continuous", "a", "b", kLimits));
  EXPECT_FALSE(variable(*robot, "j").bounded);
  EXPECT_EQ(variable(*robot, "j").lower, -kPi);
  EXPECT_EQ(variable(*robot, "j").upper, kPi);
}

TEST(Joints, PlanarAndFloatingJointsHaveMoveItsVariables)
{
  const auto robot =
      robotOf(boxLink("a") + boxLink("b") + boxLink("c") + jointXml("p", "planar", "a", "b", "<axis xyz=\"0 0 1\"/>") +
              jointXml("q", "floating", "b", "c"));
  EXPECT_EQ(variableNames(*robot), (std::vector<std::string>{"p/x", "p/y", "p/theta", "q/trans_x", "q/trans_y",
                                                             "q/trans_z", "q/rot_x", "q/rot_y", "q/rot_z", "q/rot_w"}));
  EXPECT_EQ(variable(*robot, "p/y").upper, 1.0);
  EXPECT_EQ(variable(*robot, "p/theta").upper, kPi);
  EXPECT_EQ(robot->joints()[1].first_variable, 3);
  EXPECT_FALSE(variable(*robot, "q/trans_x").bounded);
}

TEST(Joints, APlanarJointWithoutAnAxisGivesAWarning)
{
  std::vector<std::string> warnings;
  const auto robot = robotOf(twoLinks() + jointXml("j", "planar", "a", "b"), "", &warnings);
  EXPECT_EQ(robot->joints()[0].axis, Eigen::Vector3d::UnitX());
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("joint 'j' is planar and has no <axis>"), std::string::npos) << warnings[0];
}

TEST(Joints, TheRangeOfUnboundedTranslationsCanBeSet)
{
  RobotModelOptions options;
  options.unbounded_translation = 2.5;
  const auto robot = RobotModel::fromXml(
      "<robot name=\"r\">" + twoLinks() + jointXml("j", "floating", "a", "b") + "</robot>", "", options);
  EXPECT_EQ(variable(*robot, "j/trans_z").lower, -2.5);
  EXPECT_EQ(variable(*robot, "j/trans_z").upper, 2.5);
  EXPECT_EQ(variable(*robot, "j/rot_w").upper, 1.0);
}

TEST(Joints, AJointsNumberOfVariablesFollowsItsType)
{
  EXPECT_EQ(variableCount(JointType::Fixed), 0);
  EXPECT_EQ(variableCount(JointType::Prismatic), 1);
  EXPECT_EQ(variableCount(JointType::Planar), 3);
  EXPECT_EQ(variableCount(JointType::Floating), 7);
}

TEST(Joints, LinksAndJointsAreInMoveItsOrder)
{
  // Depth first; the children of a link in the order of their joints' names.
  const auto robot = robotOf(armUrdf());
  std::vector<std::string> links;
  for (const Link& link : robot->links())
    links.push_back(link.name);
  EXPECT_EQ(links, (std::vector<std::string>{"base", "upper", "fore", "hand", "finger_left", "finger_right", "head"}));
  EXPECT_EQ(variableNames(*robot), (std::vector<std::string>{"arm_1", "arm_2", "left", "pan"}));
  EXPECT_EQ(robot->jointIndex("pan"), 5);
  EXPECT_EQ(robot->links()[6].parent_joint, 5);
  EXPECT_EQ(robot->joints()[5].parent_link, 0);
  EXPECT_EQ(robot->joints()[5].child_link, 6);
}

TEST(Joints, NamesThatDoNotExistHaveIndexMinusOne)
{
  const auto robot = robotOf(armUrdf());
  EXPECT_EQ(robot->linkIndex("arm_1"), -1);
  EXPECT_EQ(robot->jointIndex("base"), -1);
  EXPECT_EQ(robot->variableIndex("right"), -1) << "a mimic joint has no variable of its own";
}

TEST(Joints, AChainOfMimicsFollowsItsFinalLeader)
{
  const auto robot =
      robotOf(boxLink("a") + boxLink("b") + boxLink("c") + boxLink("d") + jointXml("leader", "continuous", "a", "d") +
              jointXml("first", "revolute", "a", "b",
                       kLimits + std::string(R"(<mimic joint="second" multiplier="2" offset="0.5"/>)")) +
              jointXml("second", "prismatic", "a", "c",
                       kLimits + std::string(R"(<mimic joint="leader" multiplier="3" offset="-1"/>)")));
  ASSERT_EQ(variableNames(*robot), (std::vector<std::string>{"leader"}));
  const Joint& second = robot->joints()[robot->jointIndex("second")];
  EXPECT_EQ(second.multiplier, 3.0);
  EXPECT_EQ(second.offset, -1.0);
  const Joint& first = robot->joints()[robot->jointIndex("first")];
  EXPECT_TRUE(first.mimic);
  EXPECT_EQ(first.first_variable, 0);
  EXPECT_EQ(first.multiplier, 6.0);
  EXPECT_EQ(first.offset, -1.5);  // 2 (3 x - 1) + 0.5
}

TEST(Joints, NoFollowerTurnsByAnInfiniteAngle)
{
  const auto with_multiplier = [](const std::string& multiplier)
  {
    return robotOf(
        boxLink("a") + boxLink("b") + boxLink("c") + jointXml("leader", "continuous", "a", "b") +
        jointXml("follower", "continuous", "a", "c", "<mimic joint='leader' multiplier='" + multiplier + "'/>"));
  };
  const double largest = with_multiplier("2e10")->variables()[0].largest;
  EXPECT_TRUE(std::isfinite(2e10 * largest)) << largest;
  EXPECT_GT(largest, 1e6);
  EXPECT_THROW(with_multiplier("inf"), Error);
}

TEST(Joints, AdjacentLinksStepOverLinksWithoutShapes)
{
  const std::string urdf = boxLink("a") + "<link name=\"empty\"/>" + boxLink("b") + boxLink("c") +
                           jointXml("1", "fixed", "a", "empty") + jointXml("2", "fixed", "empty", "b") +
                           jointXml("3", "continuous", "empty", "c");
  const auto robot = robotOf(urdf);
  const int a = robot->linkIndex("a"), b = robot->linkIndex("b"), c = robot->linkIndex("c");
  // b and c hang on the same empty link, but neither is above the other.
  EXPECT_EQ(robot->adjacentLinks(), (std::vector<std::pair<int, int>>{{a, b}, {a, c}}));
}

TEST(Joints, AdjacentLinksHaveAtMostOneMovingJointBetweenThem)
{
  const auto are_adjacent = [](const std::vector<std::string>& types, const std::string& inside = kLimits)
  {
    std::string urdf =
        boxLink("a") + boxLink("leaf") + boxLink("b") + jointXml("leader", "prismatic", "a", "leaf", kLimits);
    std::string parent = "a";
    for (std::size_t i = 0; i < types.size(); ++i)
    {
      const std::string child = i + 1 == types.size() ? "b" : "empty_" + std::to_string(i);
      if (child != "b")
        urdf += "<link name='" + child + "'/>";
      urdf += jointXml("j" + std::to_string(i), types[i], parent, child, types[i] == "fixed" ? "" : inside);
      parent = child;
    }
    const auto robot = robotOf(urdf);
    const auto pairs = robot->adjacentLinks();
    const std::pair<int, int> pair = {robot->linkIndex("a"), robot->linkIndex("b")};
    return std::find(pairs.begin(), pairs.end(), pair) != pairs.end();
  };
  const std::string mimic = std::string(kLimits) + "<mimic joint='leader'/>";
  EXPECT_TRUE(are_adjacent({"fixed"}));
  EXPECT_TRUE(are_adjacent({"fixed", "fixed", "fixed"}));
  EXPECT_TRUE(are_adjacent({"revolute"}));
  EXPECT_TRUE(are_adjacent({"fixed", "continuous", "fixed"}));
  EXPECT_TRUE(are_adjacent({"prismatic"}, mimic));
  EXPECT_FALSE(are_adjacent({"revolute", "revolute"}));
  EXPECT_FALSE(are_adjacent({"revolute", "revolute", "revolute"})) << "a shoulder of three joints";
  EXPECT_FALSE(are_adjacent({"revolute", "fixed", "prismatic"}));
  EXPECT_FALSE(are_adjacent({"fixed", "prismatic", "prismatic"}, mimic)) << "a joint that mimics another one moves";
  EXPECT_FALSE(are_adjacent({"planar"})) << "as three joints that together move in a plane";
  EXPECT_FALSE(are_adjacent({"floating"})) << "no bearing holds the two links together";
  EXPECT_FALSE(are_adjacent({"fixed", "floating", "fixed"}));
}

TEST(Joints, ChildrenOfAnEmptyRootAreNotAdjacent)
{
  const auto robot = robotOf("<link name=\"empty\"/>" + twoLinks() + jointXml("1", "fixed", "empty", "a") +
                             jointXml("2", "fixed", "empty", "b"));
  EXPECT_TRUE(robot->adjacentLinks().empty());
}

TEST(Joints, EveryCollisionElementOfALinkCountsWithItsOrigin)
{
  const auto robot = robotOf(R"(<link name="a">
    <collision><origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/><geometry><box size="1 2 3"/></geometry></collision>
    <collision><geometry><sphere radius="4"/></geometry></collision>
    <collision><geometry><cylinder radius="5" length="6"/></geometry></collision>
    <visual><geometry><sphere radius="9"/></geometry></visual></link>)");
  const auto& shapes = robot->links()[0].shapes;
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(std::get<Box>(shapes[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE((shapes[0].pose * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 3, 3), 1e-15));
  EXPECT_EQ(std::get<Sphere>(shapes[1].shape).radius, 4.0);
  EXPECT_EQ(std::get<Cylinder>(shapes[2].shape).length, 6.0);
  EXPECT_EQ(robot->triangleCount(), 0u);
}

TEST(Joints, VisualsAreNoCollisionGeometryAndSayingSoIsAWarning)
{
  std::vector<std::string> warnings;
  const auto robot =
      robotOf("<link name=\"a\"><visual><geometry><sphere radius=\"1\"/></geometry></visual></link>", "", &warnings);
  EXPECT_TRUE(robot->links()[0].shapes.empty());
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("test.urdf:1: link 'a'"), std::string::npos) << warnings[0];
}

TEST(Joints, LeftoversOfXacroAreHarmless)
{
  const auto robot = RobotModel::fromXml(R"(<?xml version="1.0"?>
    <!-- made by xacro -->
    <robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:property name="x" value="1"/>
    <link name="a"/><gazebo reference="a"><material>Red</material></gazebo><transmission name="t"/></robot>)",
                                         "", RobotModelOptions());
  EXPECT_EQ(robot->links().size(), 1u);
  EXPECT_EQ(robot->planningFrame(), "a");
}
}  // namespace
}  // namespace gpu_planning_scene::core
