// Bounds on the positions of links hold for every state within the limits, and are tight enough to be useful.
#include "collision/bounds/reach.h"

#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "collision/geometry/shape_bounds.h"
#include "model/model_testing.h"
#include "model/real_robots.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A robot with all kinds of joints that have bounds. Two joints are mimics with negative multipliers.
std::shared_ptr<const RobotModel> oddRobot()
{
  const std::string limit = "<limit lower='-1.5' upper='0.7' effort='1' velocity='1'/>";
  const auto place = [](const std::string& xyz, const std::string& axis)
  { return "<origin xyz='" + xyz + "' rpy='0.3 -0.4 1.2'/><axis xyz='" + axis + "'/>"; };
  return robotOf(boxLink("a") + boxLink("b") + boxLink("c") + boxLink("d") + boxLink("e") + boxLink("f") +
                 jointXml("ab", "revolute", "a", "b", place("0.5 0 0.1", "0.6 0 0.8") + limit) +
                 jointXml("bc", "prismatic", "b", "c", place("0 0.3 0", "0 1 0") + limit) +
                 jointXml("cd", "continuous", "c", "d", place("0 0 1", "0 0.8 0.6")) +
                 jointXml("de", "revolute", "d", "e",
                          place("0.2 0 0.4", "1 0 0") + limit + "<mimic joint='ab' multiplier='-1.5' offset='0.4'/>") +
                 jointXml("bf", "prismatic", "b", "f",
                          place("0 0 0.2", "0 0 1") + limit + "<mimic joint='bc' multiplier='-2' offset='0.1'/>"));
}

std::vector<Eigen::Vector3d> cornersOf(const Link& link)
{
  std::vector<Eigen::Vector3d> corners;
  for (const PlacedShape& placed : link.shapes)
  {
    const Eigen::AlignedBox3d box = boundsOf(placed.shape);
    if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape))
      for (const Eigen::Vector3d& vertex : (*mesh)->vertices)
        corners.push_back(placed.pose * vertex);
    else
      for (int i = 0; i < 8; ++i)
        corners.push_back(placed.pose * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }
  return corners;
}

bool isHeld(const Region& region, const Eigen::Vector3d& point)
{
  const auto holds = [&point](const Ball& ball) { return (point - ball.center).norm() <= ball.radius + 1e-12; };
  return holds(region.enclosing) && std::any_of(region.balls.begin(), region.balls.end(), holds);
}

/// A random state. Each bounded variable is at a limit with probability 1/2.
std::vector<double> stateWithin(const RobotModel& robot, std::mt19937_64& generator)
{
  std::vector<double> state(robot.variables().size());
  robot.randomState(generator, state.data());
  for (std::size_t v = 0; v < state.size(); ++v)
  {
    const unsigned choice = generator() % 4;
    if (robot.variables()[v].bounded && choice < 2)
      state[v] = choice == 0 ? robot.variables()[v].lower : robot.variables()[v].upper;
  }
  return state;
}

/// Expects corners of links within the bounds, in the frames of all links above and in the planning frame.
void expectBoundsHold(const RobotModel& robot, int states)
{
  std::cout << "seed " << kSeed << std::endl;
  const Reach reach(robot);
  std::mt19937_64 generator(kSeed);
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  std::vector<std::vector<Eigen::Isometry3d>> posed;
  for (int i = 0; i < states; ++i)
  {
    const std::vector<double> state = stateWithin(robot, generator);
    robot.linkPoses(state.data(), poses.data());
    posed.push_back(poses);
  }
  for (std::size_t link = 0; link < robot.links().size(); ++link)
  {
    const std::vector<Eigen::Vector3d> corners = cornersOf(robot.links()[link]);
    if (corners.empty())
      continue;
    const SweptBody body =
        reach.sweep(robot.links()[link].shapes, Eigen::Isometry3d::Identity(), static_cast<int>(link));
    for (const auto& at : posed)
    {
      int frame = static_cast<int>(link);
      for (const Region& region : body.region_by_level)
      {
        const Eigen::Vector3d& corner = corners[generator() % corners.size()];
        const Eigen::Vector3d in_planning_frame = at[link] * corner;
        const Eigen::Vector3d point =
            frame < 0 ? in_planning_frame : at[static_cast<std::size_t>(frame)].inverse() * in_planning_frame;
        ASSERT_TRUE(isHeld(region, point))
            << robot.links()[link].name << " in the frame of " << (frame < 0 ? "the world" : robot.links()[frame].name);
        if (frame >= 0)
        {
          const int joint = robot.links()[static_cast<std::size_t>(frame)].parent_joint;
          frame = joint < 0 ? -1 : robot.joints()[static_cast<std::size_t>(joint)].parent_link;
        }
      }
    }
  }
}

TEST(Reach, ContainsAllPositionsOfEveryKindOfJoint)
{
  expectBoundsHold(*oddRobot(), 20000);
}

class ReachOfRealRobots : public testing::TestWithParam<RealRobot (*)()>
{
};

TEST_P(ReachOfRealRobots, HoldsWhereTheirLinksGo)
{
  SKIP_WITHOUT(GetParam()());
  expectBoundsHold(*GetParam()().load(), 2000);
}
INSTANTIATE_TEST_SUITE_P(Robots, ReachOfRealRobots, testing::Values(&kr5, &wam, &drchubo, &ur5Robotiq));

/// The region of a rod of one metre that turns about z at one end, by up to `angle` in both directions.
Region regionOfRod(double angle)
{
  const std::string limit =
      "<limit lower='" + std::to_string(-angle) + "' upper='" + std::to_string(angle) + "' effort='1' velocity='1'/>";
  const auto robot = robotOf(
      "<link name='base'/><link name='rod'><collision><origin xyz='0.5 0 0'/><geometry><box size='1 0.04 0.04'/>"
      "</geometry></collision></link>" +
      jointXml("swing", "revolute", "base", "rod", "<axis xyz='0 0 1'/>" + limit));
  const Reach reach(*robot);
  return *reach.inPlanningFrame(reach.sweep(robot->links()[1].shapes, Eigen::Isometry3d::Identity(), 1));
}

bool rodMayMeetBallAt(double angle, double x, double y)
{
  const PlacedBox box(Eigen::Isometry3d(Eigen::Translation3d(x, y, 0.0)), Eigen::Vector3d::Constant(0.01));
  return mayMeet(regionOfRod(angle), box, 0.0);
}

TEST(Reach, IsTightForARod)
{
  EXPECT_TRUE(rodMayMeetBallAt(0.5, 0.9, 0.4));    // within its angles
  EXPECT_FALSE(rodMayMeetBallAt(0.5, 1.25, 0.0));  // beyond its end
  EXPECT_FALSE(rodMayMeetBallAt(0.5, 0.2, 0.9));   // beside its angles
  EXPECT_FALSE(rodMayMeetBallAt(0.5, -0.4, 0.0));  // behind
  EXPECT_TRUE(rodMayMeetBallAt(3.2, -0.9, 0.0));   // a full turn
  EXPECT_FALSE(rodMayMeetBallAt(3.2, -1.2, 0.0));
}

TEST(Reach, HasNoBoundBeyondJointsWithoutLimits)
{
  const auto robot =
      robotOf(boxLink("base") + boxLink("cart") + boxLink("arm") +
              jointXml("roll", "planar", "base", "cart", "<axis xyz='0 0 1'/>") +
              jointXml("swing", "revolute", "cart", "arm", std::string("<axis xyz='0 0 1'/>") + kLimits));
  const Reach reach(*robot);
  const SweptBody arm = reach.sweep(robot->links()[2].shapes, Eigen::Isometry3d::Identity(), 2);
  EXPECT_EQ(reach.inPlanningFrame(arm), nullptr);
  EXPECT_EQ(arm.region_by_level.size(), 2U);  // in the frames of the arm and the cart
}
}  // namespace
}  // namespace gpu_planning_scene::core
