// The rest of trajectories is checked while the scene changes: no collision is missed, and none is invented. Two
// trajectories are checked in time. The latest moment to brake is right.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/planning/trajectory_watch.h"
#include "gpu_planning_scene/state_inspector.h"
#include "model/model_testing.h"
#include "support/fcl_peer.h"
#include "support/repetitions.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kInfinity = std::numeric_limits<double>::infinity();

MotionChecker checkerOf(const std::shared_ptr<const PlanningScene>& scene)
{
  return {std::make_shared<CpuChecker>(scene), scene->robot, "", {}};
}

std::vector<double> stateAt(const RobotModel& robot, const TimedRows& motion, double time)
{
  WatchedTrajectory all;
  for (std::size_t i = 0; i < robot.variables().size(); ++i)
    all.columns.push_back(static_cast<int>(i));
  all.rows = motion;
  return rowAt(robot, all, time);
}

/// Expects that a motion is free until a time, up to two samples of 0.02 m before.
void expectUntil(const MotionOutlook& outlook, double time)
{
  EXPECT_FALSE(outlook.free);
  EXPECT_LE(outlook.free_until, time);
  EXPECT_GT(outlook.free_until, time - 0.05);
}

/// Two carts on crossing rails, each a cube of 0.2 m: `east` moves along x, `north` along y. They meet at the origin.
std::shared_ptr<const PlanningScene> crossing()
{
  const auto rail = [](const std::string& name, const std::string& axis)
  {
    return "<link name='" + name +
           "_cart'><collision><geometry><box size='0.2 0.2 0.2'/></geometry></collision></link>" +
           jointXml(name, "prismatic", "base", name + "_cart",
                    "<axis xyz='" + axis + "'/><limit lower='-5' upper='5' effort='1' velocity='1'/>");
  };
  return std::make_shared<const PlanningScene>(
      robotOf("<link name='base'/>" + rail("east", "1 0 0") + rail("north", "0 1 0")));
}

class Crossing : public testing::Test
{
 protected:
  const std::shared_ptr<const PlanningScene> scene_ = crossing();
  const RobotModel& robot_ = *scene_->robot;
  const MotionChecker checker_ = checkerOf(scene_);
  const int east_ = robot_.variableIndex("east");
  const int north_ = robot_.variableIndex("north");

  /// From -1 m to 1 m in two seconds, beginning at `start`.
  static WatchedTrajectory along(int column, double start) { return {{column}, {{start, start + 2.0}, {-1.0, 1.0}}}; }

  MotionOutlook outlook(const WatchedTrajectory& a, const WatchedTrajectory& b, double from = 0.0,
                        double delay_of_b = 0.0) const
  {
    const TimedRows motion = motionOfAll(robot_, {&a, &b}, {0.0, delay_of_b}, {-1.0, -1.0}, from);
    return outlookOf(checker_, robot_, motion);
  }
};

TEST_F(Crossing, TwoTrajectoriesCollideOnlyIfTheyAreAtTheSamePlaceAtTheSameTime)
{
  const MotionOutlook together = outlook(along(east_, 0.0), along(north_, 0.0));
  EXPECT_FALSE(together.free);
  EXPECT_NE(together.colliding, kNoPair);
  expectUntil(together, 0.8);  // the cubes touch where both are 0.2 m before the origin
  EXPECT_LE(together.free_until, together.collision);
  const MotionOutlook later = outlook(along(east_, 0.0), along(north_, 0.5));
  EXPECT_TRUE(later.free);
  EXPECT_EQ(later.free_until, 2.5);
  EXPECT_EQ(later.collision, kInfinity);
  EXPECT_EQ(later.brake_by, kInfinity);
  EXPECT_FALSE(outlook(along(east_, 0.0), along(north_, 0.5), 0.0, -0.5).free) << "a delay moves a trajectory in time";
}

TEST_F(Crossing, WhatHasPassedDoesNotCount)
{
  EXPECT_FALSE(outlook(along(east_, 0.0), along(north_, 0.0), 1.15).free);
  EXPECT_TRUE(outlook(along(east_, 0.0), along(north_, 0.0), 1.25).free);
}

TEST_F(Crossing, ADelayedTrajectoryHasItsRowsLater)
{
  const WatchedTrajectory a = along(east_, 0.5);  // to 2.5 s
  const TimedRows early = motionOfAll(robot_, {&a}, {-1.0}, {-1.0, -1.0}, 0.0);
  EXPECT_EQ(early.seconds, (std::vector<double>{0.0, 1.5}));
  EXPECT_NEAR(early.values[static_cast<std::size_t>(east_)], -0.5, 1e-12) << "where the trajectory is at 1 s";
  const TimedRows late = motionOfAll(robot_, {&a}, {1.0}, {-1.0, -1.0}, 0.0);
  EXPECT_EQ(late.seconds, (std::vector<double>{0.0, 1.5, 3.5}));
}

TEST_F(Crossing, ATimeThatIsNotFiniteIsRefused)
{
  const WatchedTrajectory a = along(east_, 0.0);
  EXPECT_THROW(motionOfAll(robot_, {&a}, {0.0}, {-1.0, -1.0}, std::nan("")), Error);
  EXPECT_THROW(motionOfAll(robot_, {&a}, {kInfinity}, {-1.0, -1.0}, 0.0), Error);
}

TEST_F(Crossing, ATrajectoryStandsBeforeItsStartAndAfterItsEnd)
{
  const WatchedTrajectory into_the_way = {{north_}, {{0.0, 1.0}, {-1.0, 0.0}}};
  const MotionOutlook blocked = outlook(along(east_, 2.0), into_the_way);
  expectUntil(blocked, 2.8);  // north stands at the origin from 1 s on
  const WatchedTrajectory out_of_the_way = {{north_}, {{3.0, 4.0}, {0.0, 1.0}}};
  expectUntil(outlook(along(east_, 0.0), out_of_the_way), 0.8);  // north waits at the origin
}

/// A cart that moves towards a wall.
class Braking : public testing::Test
{
 protected:
  Braking() : scene_(wallBefore({})) {}

  static std::shared_ptr<const PlanningScene> wallBefore(const RobotModelOptions& options)
  {
    PlanningScene made(RobotModel::fromXml(
        "<robot name='test'><link name='base'/><link name='cart'><collision><geometry><box size='0.2 0.2 0.2'/>"
        "</geometry></collision></link>" +
            jointXml("slide", "prismatic", "base", "cart",
                     "<axis xyz='1 0 0'/><limit lower='-5' upper='5' effort='1' velocity='4'/>") +
            "</robot>",
        "", options));
    WorldObject wall;
    wall.id = "wall";
    wall.pose = Eigen::Translation3d(1.2, 0.0, 0.0);
    wall.shapes = {{Box{{0.2, 1.0, 1.0}}}};
    made.objects = {wall};
    return std::make_shared<const PlanningScene>(made);
  }

  MotionOutlook outlook(const TimedRows& motion) const { return outlookOf(checkerOf(scene_), *scene_->robot, motion); }

  std::shared_ptr<const PlanningScene> scene_;
};

TEST_F(Braking, BeginsHalfTheBrakingTimeBeforeTheLastFreeState)
{
  // At 1 m/s and 1 m/s^2, which counts without a limit, braking takes 1 s and 0.5 m: half a second of the motion.
  const MotionOutlook found = outlook({{0.0, 2.0}, {0.0, 2.0}});
  expectUntil(found, 1.0);
  EXPECT_NEAR(found.brake_by, found.free_until - 0.5, 1e-12);
}

TEST_F(Braking, TakesTheLimitOfTheJoint)
{
  RobotModelOptions options;
  options.joint_limits = {JointLimits{"slide"}};
  options.joint_limits[0].max_acceleration = 2.0;
  scene_ = wallBefore(options);
  const MotionOutlook found = outlook({{0.0, 2.0}, {0.0, 2.0}});
  EXPECT_NEAR(found.brake_by, found.free_until - 0.25, 1e-12);
}

TEST_F(Braking, CountsFasterPartsThatTheRobotStillPasses)
{
  // 0.5 m/s in the last part: half a second, so the robot would begin to brake in the part before. There it moves with
  // 2 m/s and brakes in two seconds.
  const MotionOutlook found = outlook({{0.0, 1.0, 2.0}, {-1.1, 0.9, 1.4}});
  expectUntil(found, 1.2);
  EXPECT_NEAR(found.brake_by, found.free_until - 1.0, 1e-12);
}

TEST_F(Braking, IsNotShorterBecauseItBeginsInASlowerPart)
{
  // At 2 m/s from 1 s on, and at 0.4 m/s before.
  const MotionOutlook found = outlook({{0.0, 1.0, 2.0}, {0.3, 0.7, 2.7}});
  expectUntil(found, 1.15);
  EXPECT_NEAR(found.brake_by, found.free_until - 1.0, 1e-12);
}

TEST_F(Braking, IsTooLateIfTheRobotIsTooFast)
{
  EXPECT_EQ(outlook({{0.0, 1.0}, {0.8, 4.0}}).brake_by, -kInfinity);
}

TEST_F(Braking, ARobotThatStandsIsCheckedToo)
{
  EXPECT_TRUE(outlook({{5.0}, {0.0}}).free);
  const MotionOutlook inside = outlook({{5.0}, {1.1}});
  EXPECT_FALSE(inside.free);
  EXPECT_EQ(inside.collision, 5.0);
  EXPECT_EQ(inside.free_until, 5.0);
}

/// Of a trajectory of one cart.
Progress progressOn(const TimedRows& rows, double value, double from)
{
  const auto scene = crossing();
  return progressFrom(*scene->robot, {{scene->robot->variableIndex("east")}, rows}, {value}, from);
}

void expectProgress(const Progress& found, double time, double deviation)
{
  EXPECT_NEAR(found.time, time, 1e-12);
  EXPECT_NEAR(found.deviation, deviation, 1e-12);
}

TEST(ProgressFrom, NeverSkipsAPartOfATrajectoryThatTurnsBack)
{
  // Forth and back: each place is passed twice.
  const TimedRows rows = {{0.0, 1.0, 2.0}, {0.0, 1.0, 0.0}};
  expectProgress(progressOn(rows, 0.25, 0.0), 0.25, 0.0);
  expectProgress(progressOn(rows, 0.25, 0.5), 0.5, 0.25);  // the robot does not go back
  expectProgress(progressOn(rows, 1.3, 0.0), 1.0, 0.3);    // beside the turning point, and not after it
  expectProgress(progressOn(rows, 0.4, 1.0), 1.6, 0.0);
  expectProgress(progressOn(rows, -0.5, 1.0), 2.0, 0.5);
}

TEST(ProgressFrom, ATurningPointThatTheRobotDoesNotQuiteReachIsPassedOnTheWayBack)
{
  const TimedRows rows = {{0.0, 1.0, 2.0}, {0.0, 1.0, 0.0}};
  expectProgress(progressOn(rows, 0.995, 0.9), 0.995, 0.0);
  expectProgress(progressOn(rows, 0.95, 0.995), 1.05, 0.0);
  expectProgress(progressOn(rows, 0.95, 0.98), 0.98, 0.03);  // too far from the turning point
  // The same with dense points before the turning point, and with a stop there.
  expectProgress(progressOn({{0.0, 0.99, 0.995, 1.0, 2.0}, {0.0, 0.99, 0.995, 1.0, 0.0}}, 0.95, 0.991), 1.05, 0.0);
  expectProgress(progressOn({{0.0, 1.0, 5.0, 6.0}, {0.0, 1.0, 1.0, 0.0}}, 0.95, 0.996), 5.05, 0.0);
}

TEST(ProgressFrom, ARobotThatIsAheadInOneJointSkipsNoMotionOfAnotherJoint)
{
  // One cart hardly moves. The other one goes 4 cm forth and back, with a row each 8 mm.
  const auto scene = crossing();
  WatchedTrajectory trajectory;
  trajectory.columns = {scene->robot->variableIndex("east"), scene->robot->variableIndex("north")};
  for (int row = 0; row <= 10; ++row)
  {
    trajectory.rows.seconds.push_back(row);
    trajectory.rows.values.push_back(0.001 * row);
    trajectory.rows.values.push_back(0.008 * std::min(row, 10 - row));
  }
  EXPECT_LT(progressFrom(*scene->robot, trajectory, {0.05, 0.0}, 0.0).time, 2.0);
}

TEST(ProgressFrom, ARobotThatStandsAtTheStartOfALoopStaysThere)
{
  expectProgress(progressOn({{0.0, 1.0, 2.0, 3.0}, {0.0, 1.0, -1.0, 0.0}}, 1e-5, 0.0), 1e-5, 0.0);
}

TEST(ProgressFrom, APartWithoutMotionIsPassed)
{
  const TimedRows rows = {{0.0, 1.0, 5.0, 6.0}, {0.0, 1.0, 1.0, 2.0}};
  expectProgress(progressOn(rows, 1.0, 0.5), 5.0, 0.0);
  expectProgress(progressOn(rows, 1.5, 0.5), 5.5, 0.0);
}

TEST(ProgressFrom, AFullTurnOfAContinuousJointIsNoDeviation)
{
  const auto robot = robotOf("<link name='base'/>" + boxLink("wheel") +
                             jointXml("turn", "continuous", "base", "wheel", "<axis xyz='0 0 1'/>"));
  const WatchedTrajectory turn = {{0}, {{0.0, 1.0}, {3.0, 3.5}}};
  const Progress found = progressFrom(*robot, turn, {3.25 - 2.0 * M_PI}, 0.0);
  EXPECT_NEAR(found.time, 0.5, 1e-9);
  EXPECT_NEAR(found.deviation, 0.0, 1e-9);
}

TEST(OutlookOf, EndsWhenItIsTold)
{
  const auto scene = crossing();
  const TimedRows motion = {{0.0, 1.0}, {-1.0, -1.0, 1.0, -1.0}};
  EXPECT_THROW(outlookOf(checkerOf(scene), *scene->robot, motion, [] { return true; }), Cancelled);
}

TEST(ValidateTrajectory, NamesTheWrongRow)
{
  const auto error = [](const TimedRows& rows) { return errorOf([&] { validateTrajectory({{0}, rows}); }); };
  EXPECT_EQ(error({{0.0, 1.0}, {0.0, 1.0}}), "");
  EXPECT_NE(error({{}, {}}).find("at least one"), std::string::npos);
  EXPECT_NE(error({{0.0, 1.0}, {0.0}}).find("1 values for 2 rows"), std::string::npos);
  EXPECT_NE(error({{0.0, 0.0}, {0.0, 1.0}}).find("row 1"), std::string::npos);
  EXPECT_NE(error({{0.0, std::nan("")}, {0.0, 1.0}}).find("row 1"), std::string::npos);
  EXPECT_NE(error({{0.0, 1.0}, {0.0, std::nan("")}}).find("not a finite number"), std::string::npos);
}

class WatchedScenes : public testing::TestWithParam<const char*>
{
 protected:
  void SetUp() override
  {
    if (const std::string missing = missingFor(GetParam()); !missing.empty())
      GTEST_SKIP() << "there is no " << missing;
    test_ = &testScene(GetParam());
    std::cout << "seed " << seed_ << "\n";
  }

  double uniform(double lower, double upper)
  {
    return std::uniform_real_distribution<double>(lower, upper)(generator_);
  }

  /// A trajectory of all variables through eight random states, which are drawn towards the first one. It is free in
  /// the scene of the test.
  WatchedTrajectory freeTrajectory()
  {
    const MotionChecker checker = checkerOf(test_->scene);
    const RobotModel& robot = *test_->scene->robot;
    while (true)
    {
      WatchedTrajectory made = randomTrajectory();
      if (outlookOf(checker, robot, motionOfAll(robot, {&made}, {0.0}, test_->lower, 0.0)).free)
        return made;
    }
  }

  WatchedTrajectory randomTrajectory()
  {
    const std::size_t width = test_->lower.size();
    WatchedTrajectory made;
    std::vector<double> state = test_->randomStates(1, generator_());
    for (std::size_t i = 0; i < width; ++i)
      made.columns.push_back(static_cast<int>(i));
    for (int row = 0; row < 8; ++row)
    {
      made.rows.seconds.push_back(row + uniform(0.0, 0.9));
      made.rows.values.insert(made.rows.values.end(), state.begin(), state.end());
      const std::vector<double> towards = test_->randomStates(1, generator_());
      for (std::size_t i = 0; i < width; ++i)
        state[i] += 0.1 * (towards[i] - state[i]);
    }
    return made;
  }

  /// Adds a box, or moves it: often to a place where a link will be, else to a random one.
  void change(const WatchedTrajectory& trajectory, PlanningScene& scene)
  {
    constexpr std::size_t kBoxes = 3;
    const RobotModel& robot = *scene.robot;
    WorldObject box;
    box.id = "box " + std::to_string(generator_() % kBoxes);
    box.pose = Eigen::Translation3d(uniform(-1.2, 1.2), uniform(-1.2, 1.2), uniform(-0.2, 1.2));
    if (uniform(0.0, 1.0) < 0.2)
    {
      std::vector<Eigen::Isometry3d> poses(robot.links().size());
      robot.linkPoses(rowAt(robot, trajectory, uniform(0.0, 8.0)).data(), poses.data());
      box.pose = Eigen::Translation3d(poses[generator_() % poses.size()].translation());
    }
    box.shapes = {{Box{{uniform(0.02, 0.2), uniform(0.02, 0.2), uniform(0.02, 0.2)}}}};
    const auto same = std::find_if(scene.objects.begin(), scene.objects.end(),
                                   [&](const WorldObject& object) { return object.id == box.id; });
    if (same != scene.objects.end())
      *same = box;
    else
      scene.objects.push_back(box);
  }

  const TestScene* test_ = nullptr;
  const std::uint64_t seed_ = std::random_device()();
  std::mt19937_64 generator_{seed_};
};

TEST_P(WatchedScenes, NoCollisionOfTheRestIsMissedAndNoneIsInvented)
{
  constexpr int kTrajectories = repetitions(4, 100);
  constexpr int kChanges = repetitions(12, 100);  // for each trajectory
  constexpr int kSamples = repetitions(60, 200);
  const RobotModel& robot = *test_->scene->robot;
  int free = 0;
  int changes = 0;
  const auto checker = std::make_shared<CpuChecker>(test_->scene);
  // Keeps FCL's trees of the robot for the peers of all scenes.
  const FclPeer keeper(std::make_shared<const CollisionProblem>(makeProblem(*test_->scene, "", nullptr)));
  for (int t = 0; t < kTrajectories; ++t)
  {
    const WatchedTrajectory trajectory = freeTrajectory();
    PlanningScene scene = *test_->scene;
    for (int c = 0; c < kChanges; ++c)
    {
      change(trajectory, scene);
      const auto now = std::make_shared<const PlanningScene>(scene);
      checker->setScene(now);
      const double from = uniform(0.0, trajectory.rows.seconds.back());
      const TimedRows motion = motionOfAll(robot, {&trajectory}, {0.0}, test_->lower, from);
      const MotionOutlook outlook = outlookOf(MotionChecker(checker, now->robot, "", {}), robot, motion);
      ++changes;
      free += outlook.free ? 1 : 0;

      FclPeer fcl(std::make_shared<const CollisionProblem>(makeProblem(*now, "", nullptr)));
      std::vector<Eigen::Isometry3d> poses(robot.links().size());
      const auto collides = [&](const std::vector<double>& state)
      {
        robot.linkPoses(state.data(), poses.data());
        fcl.setState(poses.data());
        return fcl.firstCollision();
      };
      const double end = outlook.free ? trajectory.rows.seconds.back() : outlook.free_until;
      for (int i = 0; i < kSamples && end > from; ++i)
      {
        const double time = from + (end - from) * i / kSamples;
        const auto pair = collides(stateAt(robot, motion, time));
        ASSERT_TRUE(!pair || fcl.freeWhenMovedApart(*pair))
            << "missed: trajectory " << t << ", change " << c << ", " << time << " s of " << from << " to " << end;
      }
      if (outlook.free)
        continue;
      const std::vector<double> then = stateAt(robot, motion, outlook.collision);
      for (std::size_t i = 0; i < then.size(); ++i)
        EXPECT_NEAR(outlook.state[i], then[i], 1e-9);
      EXPECT_LE(outlook.free_until, outlook.collision);
      EXPECT_LE(outlook.brake_by, outlook.free_until);
      const double clearance = StateInspector(now).clearance(outlook.state.data(), "").world;
      const double self = StateInspector(now).clearance(outlook.state.data(), "").self;
      if (outlook.colliding != kNoPair)
        EXPECT_TRUE(collides(outlook.state) || std::min(clearance, self) == 0.0) << "invented";
      else
        EXPECT_LT(std::min(clearance, self), 1e-3) << "not proven, but far from a collision";
    }
  }
  std::cout << free << " of " << changes << " free\n";
  EXPECT_GT(free, 0);
  EXPECT_LT(free, changes);
}

INSTANTIATE_TEST_SUITE_P(Scenes, WatchedScenes, testing::Values("arm_boxes", "kr5_boxes", "panda_boxes", "ur5_box"));
}  // namespace
}  // namespace gpu_planning_scene::core
