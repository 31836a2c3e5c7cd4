// A state is not free in its neighbourhood if the arm can reach an obstacle there. It is free if the arm cannot.

#include <cmath>
#include <tuple>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr char kTurns[] = "<axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='1' velocity='1'/>";
constexpr char kSlides[] = "<axis xyz='0 1 0'/><limit lower='-0.02' upper='0.02' effort='1' velocity='1'/>";
constexpr double kTravel = 0.01;  // radians or metres: travel of each joint
constexpr double kBall = 0.01;    // metres: radius of the ball at the tip

std::string ballLink(const std::string& name, double radius)
{
  return "<link name='" + name + "'><collision><geometry><sphere radius='" + std::to_string(radius) +
         "'/></geometry></collision></link>";
}

/// Two links of 0.5 m along x that turn about z, a slide along y, and a ball at its end, 1 m from the first joint.
/// `finger`: adds a finger of 0.25 m that mimics the first joint with multiplier -4.
std::shared_ptr<const RobotModel> arm(bool finger = false)
{
  std::string urdf = "<link name='base'/><link name='upper'/><link name='fore'/>" + ballLink("tip", kBall) +
                     jointXml("shoulder", "revolute", "base", "upper", kTurns) +
                     jointXml("elbow", "revolute", "upper", "fore", std::string("<origin xyz='0.5 0 0'/>") + kTurns) +
                     jointXml("slide", "prismatic", "fore", "tip", std::string("<origin xyz='0.5 0 0'/>") + kSlides);
  if (finger)
    urdf += ballLink("knuckle", 0.001) + ballLink("fingertip", kBall) +
            jointXml("bend", "revolute", "tip", "knuckle",
                     "<origin xyz='0 0.2 0'/><axis xyz='0 0 1'/><limit lower='-4' upper='4' effort='1' velocity='1'/>"
                     "<mimic joint='shoulder' multiplier='-4'/>") +
            jointXml("nail", "fixed", "knuckle", "fingertip", "<origin xyz='0.25 0 0'/>");
  return robotOf(urdf);
}

class Displacement : public testing::Test
{
 protected:
  /// A ball in the world. The gap along y between it and a ball of the robot at `at` is `gap` metres.
  static std::shared_ptr<PlanningScene> sceneWith(const std::shared_ptr<const RobotModel>& robot,
                                                  const Eigen::Vector3d& at, double gap)
  {
    auto scene = std::make_shared<PlanningScene>(robot);
    WorldObject ball;
    ball.id = "ball";
    ball.pose = Eigen::Translation3d(at + Eigen::Vector3d(0.0, kBall + gap + 0.1, 0.0));
    ball.shapes = {{Sphere{0.1}}};
    scene->objects = {ball};
    return scene;
  }

  static JointNeighbourhood allTravel(const RobotModel& robot)
  {
    JointNeighbourhood around;
    for (const Joint& joint : robot.joints())
      around.travel.push_back(joint.type == JointType::Prismatic  ? JointTravel{kTravel, 0.0}
                              : joint.type == JointType::Revolute ? JointTravel{0.0, kTravel}
                                                                  : JointTravel{});
    around.rows = {0};
    return around;
  }

  static bool isFreeAround(const std::shared_ptr<PlanningScene>& scene, const JointNeighbourhood& around)
  {
    const std::vector<double> state = scene->robot->defaultState();
    return CpuChecker(scene).check(state.data(), 1, "", &around).valid[0] != 0;
  }
};

TEST_F(Displacement, OfAStretchedArmIsTheSumOfWhatItsJointsMoveTheTip)
{
  const auto robot = arm();
  const JointNeighbourhood around = allTravel(*robot);
  const double reached = kTravel * (1.0 + 0.5 + 1.0);  // shoulder, elbow, slide
  const Eigen::Vector3d tip(1.0, 0.0, 0.0);
  EXPECT_FALSE(isFreeAround(sceneWith(robot, tip, 0.99 * reached), around));
  EXPECT_TRUE(isFreeAround(sceneWith(robot, tip, 1.05 * reached), around));
  // The travel of an elbow that does not move is not counted.
  JointNeighbourhood stiff = around;
  stiff.travel[1] = {};
  EXPECT_TRUE(isFreeAround(sceneWith(robot, tip, 0.99 * reached), stiff));
  EXPECT_FALSE(isFreeAround(sceneWith(robot, tip, 0.99 * kTravel * 2.0), stiff));
}

/// The shoulder moves the tip of a bent arm less than that of a stretched one.
TEST_F(Displacement, OfABentArmIsSmallerIfTheElbowIsKnownToStayBent)
{
  const auto robot = arm();
  const double bent = 1.0;
  const Eigen::Vector3d tip(0.5 + 0.5 * std::cos(bent), 0.5 * std::sin(bent), 0.0);
  std::vector<double> state = robot->defaultState();
  state[1] = bent;
  JointNeighbourhood around;
  around.rows = {0};
  around.travel.resize(robot->joints().size());
  around.travel[0].angle = kTravel;
  const auto is_free = [&](double gap)
  { return CpuChecker(sceneWith(robot, tip, gap)).check(state.data(), 1, "", &around).valid[0] != 0; };
  const double near = kTravel * (tip.norm() + 3.0 * kBall);
  ASSERT_LT(near, kTravel);
  EXPECT_FALSE(is_free(near)) << "no centre, so the elbow may be anywhere";
  around.centers = state;
  EXPECT_TRUE(is_free(near));
  EXPECT_FALSE(is_free(0.98 * kTravel * tip.norm()));
  // The elbow may be as far from the centre as its travel times the spread, so the arm may be stretched.
  around.travel[1].angle = 1e-6;
  EXPECT_TRUE(is_free(near));
  around.spread = 1e6;
  EXPECT_FALSE(is_free(near));
}

/// A shape on one link that turns about z. Its point that is farthest from the axis moves most.
class TurningShape : public testing::TestWithParam<std::tuple<const char*, double, double>>
{
};

TEST_P(TurningShape, MovesAsFarAsItsFarthestPoint)
{
  const std::string geometry = std::get<0>(GetParam());
  const double place = std::get<1>(GetParam());
  const double farthest = std::get<2>(GetParam());
  const auto robot = robotOf("<link name='base'/><link name='turning'><collision><origin xyz='" +
                             std::to_string(place) + " 0 0'/><geometry>" + geometry + "</geometry></collision></link>" +
                             jointXml("turn", "revolute", "base", "turning", kTurns));
  const std::vector<double> state = robot->defaultState();
  const JointNeighbourhood around{{{0.0, kTravel}}, {0}, state};
  const auto is_free = [&](double gap)
  {
    auto scene = std::make_shared<PlanningScene>(robot);
    WorldObject wall;  // `gap` beside the shape, which is 0.6 m wide
    wall.id = "wall";
    wall.pose = Eigen::Translation3d(place, 0.3 + gap + 0.5, 0.0);
    wall.shapes = {{Box{{9.0, 1.0, 9.0}}}};
    scene->objects = {wall};
    return CpuChecker(scene).check(state.data(), 1, "", &around).valid[0] != 0;
  };
  EXPECT_FALSE(is_free(0.999 * kTravel * farthest));
  EXPECT_TRUE(is_free(1.5 * kTravel * farthest));  // the balls around the shape are larger than the shape
}

INSTANTIATE_TEST_SUITE_P(Shapes, TurningShape,
                         testing::Values(std::tuple("<sphere radius='0.3'/>", 0.5, 0.8),
                                         std::tuple("<box size='1.2 0.6 0.02'/>", 0.3, std::hypot(0.9, 0.3)),
                                         std::tuple("<box size='1.2 0.6 0.02'/>", -0.3, std::hypot(0.9, 0.3))));

TEST_F(Displacement, CountsTheTravelOfFollowers)
{
  const auto robot = arm(true);
  std::vector<double> from = robot->defaultState();
  std::vector<double> to = from;
  to[0] += kTravel;
  const JointNeighbourhood around{jointTravel(*robot, from.data(), to.data()), {0}};
  const Eigen::Vector3d fingertip(1.25, 0.2, 0.0);
  const double reached = kTravel * (fingertip.norm() + 4.0 * 0.25);
  EXPECT_FALSE(isFreeAround(sceneWith(robot, fingertip, 0.95 * reached), around));
  EXPECT_TRUE(isFreeAround(sceneWith(robot, fingertip, 1.2 * reached), around));
}

TEST_F(Displacement, OfTwoLinksIsThatOfOneAgainstTheOther)
{
  // The shoulder moves the fingertip and the tip together. Only the bend, which is at rest here, moves them relative to
  // each other.
  const auto robot = arm(true);
  JointNeighbourhood around = allTravel(*robot);
  auto scene = std::make_shared<PlanningScene>(robot);
  const std::vector<double> state = robot->defaultState();
  CpuChecker checker(scene);
  around.travel[static_cast<std::size_t>(robot->jointIndex("shoulder"))].angle = 1.0;
  around.travel[static_cast<std::size_t>(robot->jointIndex("bend"))].angle = 0.0;
  EXPECT_EQ(checker.check(state.data(), 1, "", &around).valid[0], 1);
  // The gap between the surfaces is 0.32 - 0.02 m. The fingertip is 0.25 m from the axis of the bend.
  around.travel[static_cast<std::size_t>(robot->jointIndex("bend"))].angle = 1.0;
  EXPECT_EQ(checker.check(state.data(), 1, "", &around).valid[0], 1);
  around.travel[static_cast<std::size_t>(robot->jointIndex("bend"))].angle = 1.3;
  EXPECT_EQ(checker.check(state.data(), 1, "", &around).valid[0], 0);
}

TEST_F(Displacement, HasNoBoundOutsideOfTheLimits)
{
  const auto robot = arm();
  const auto scene = sceneWith(robot, {5.0, 5.0, 5.0}, 1.0);
  const JointNeighbourhood around = allTravel(*robot);
  std::vector<double> state = robot->defaultState();
  CpuChecker checker(scene);
  EXPECT_EQ(checker.check(state.data(), 1, "", &around).valid[0], 1);
  state[1] = 1.1;
  EXPECT_EQ(checker.check(state.data(), 1, "", &around).valid[0], 0);
  EXPECT_EQ(checker.check(state.data(), 1).valid[0], 1);
}

/// The base stands 990 km on one side of the ball, and its neighbourhood reaches beyond the ball.
TEST_F(Displacement, OfABaseWithHugeTravelIsNotCutOff)
{
  const auto robot =
      robotOf(boxLink("base"), "<virtual_joint name='world' type='floating' parent_frame='map' child_link='base'/>");
  const auto scene = sceneWith(robot, {9.9e5, 0.0, 0.0}, 0.0);
  std::vector<double> state = robot->defaultState();
  state[0] = -9.9e5;
  JointNeighbourhood around;
  around.rows = {0};
  CpuChecker checker(scene);
  for (const auto& [length, valid] : {std::pair(1.98e6, 0), std::pair(1.97e6, 1)})
  {
    around.travel.assign(robot->joints().size(), {});
    around.travel.at(0).length = length;
    EXPECT_EQ(checker.check(state.data(), 1, "", &around).valid[0], valid) << length;
  }
}

TEST_F(Displacement, RefusesInvalidNeighbourhoods)
{
  const auto robot = arm();
  const auto scene = sceneWith(robot, {5.0, 5.0, 5.0}, 1.0);
  JointNeighbourhood around = allTravel(*robot);
  around.rows = {1};
  EXPECT_EQ(errorOf([&] { isFreeAround(scene, around); }),
            "the neighbourhood of state 0 names row 1, but there are 1 rows");
  around.rows = {0, 0};
  EXPECT_EQ(errorOf([&] { isFreeAround(scene, around); }),
            "the neighbourhood of 1 states (robot with 3 joints) has 2 row numbers and 3 joint travels");
  around = allTravel(*robot);
  around.centers = {0.0};
  EXPECT_EQ(errorOf([&] { isFreeAround(scene, around); }), "the neighbourhood has 1 values of centres; 1 rows need 3");
  around.centers.clear();
  around.spread = -1.0;
  EXPECT_EQ(errorOf([&] { isFreeAround(scene, around); }),
            "the spread of a neighbourhood is -1.000000; it must be finite and at least 0");
  around = allTravel(*robot);
  around.travel.pop_back();
  EXPECT_NE(errorOf([&] { isFreeAround(scene, around); }), "");
  around = allTravel(*robot);
  around.travel[0].angle = -1.0;
  EXPECT_EQ(errorOf([&] { isFreeAround(scene, around); }),
            "the travel of a joint around a state is 0.000000 m and -1.000000 rad; both must be finite and at least 0");
}
}  // namespace
}  // namespace gpu_planning_scene::core
