// The answers of planMotion for correct and faulty planners.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "model/model_testing.h"
#include "planning/point_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;

const std::vector<Wall> kWall = {{-0.1, -3.0, 0.1, 3.0}};

/// A planner that goes straight to the goal without checking the motion.
class Reckless : public ob::Planner
{
 public:
  explicit Reckless(const ob::SpaceInformationPtr& information) : ob::Planner(information, "Reckless") {}

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& /*ptc*/) override
  {
    pdef_->addSolutionPath(std::make_shared<PathGeometric>(si_, pis_.nextStart(), pis_.nextGoal()));
    return ob::PlannerStatus::EXACT_SOLUTION;
  }
};

/// A planner that reports a solution and has none.
class Boastful : public ob::Planner
{
 public:
  explicit Boastful(const ob::SpaceInformationPtr& information) : ob::Planner(information, "Boastful") {}

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& /*ptc*/) override
  {
    return ob::PlannerStatus::EXACT_SOLUTION;
  }
};

/// A planner whose path ends half way between start and goal. It begins at the start, or at the goal if `Backwards`.
template <bool Backwards, ob::PlannerStatus::StatusType Status = ob::PlannerStatus::EXACT_SOLUTION>
class Lost : public ob::Planner
{
 public:
  explicit Lost(const ob::SpaceInformationPtr& information) : ob::Planner(information, "Lost") {}

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& /*ptc*/) override
  {
    const ob::State* const start = pis_.nextStart();
    const ob::State* const goal = pis_.nextGoal();
    ob::ScopedState<> middle(si_);
    si_->getStateSpace()->interpolate(start, goal, 0.5, middle.get());
    pdef_->addSolutionPath(std::make_shared<PathGeometric>(si_, Backwards ? goal : start, middle.get()),
                           Status != ob::PlannerStatus::EXACT_SOLUTION, 1.0);
    return Status;
  }
};

PlanningQuery query(const std::vector<double>& start, const std::vector<std::vector<double>>& goals)
{
  PlanningQuery query;
  query.group = "plane";
  query.start = start;
  query.goals = goals;
  query.seconds = 20.0;
  return query;
}

template <class Planner>
PlanningResult plan(const std::vector<Wall>& walls, const PlanningQuery& query, const std::function<bool()>& stop = {})
{
  const PointRobot robot(walls);
  return planMotion(robot.scene(), robot.checker(), query, PlannerFactoryOf<Planner>(), stop);
}

TEST(PlanMotion, RefusesAPathThatItsPlannerHadNotChecked)
{
  for (const bool simplify : {false, true})
    for (const MotionRule rule : {MotionRule::Bound, MotionRule::Samples})
    {
      PlanningQuery wanted = query({-1.0, 0.0}, {{1.0, 0.0}});
      wanted.simplify = simplify;
      wanted.motions.rule = rule;
      EXPECT_EQ(plan<Reckless>({}, wanted).status, PlanningStatus::Solved);
      const PlanningResult refused = plan<Reckless>(kWall, wanted);
      EXPECT_EQ(refused.status, PlanningStatus::NoSolution);
      EXPECT_TRUE(refused.waypoints.empty());
      EXPECT_NE(refused.message.find("Reckless"), std::string::npos) << refused.message;
    }
}

TEST(PlanMotion, RefusesASolutionThatIsNone)
{
  const PlanningQuery wanted = query({-1.0, 0.0}, {{1.0, 0.0}});
  for (const PlanningResult& refused :
       {plan<Boastful>({}, wanted), plan<Lost<false>>({}, wanted), plan<Lost<true>>({}, wanted)})
  {
    EXPECT_EQ(refused.status, PlanningStatus::NoSolution) << refused.message;
    EXPECT_TRUE(refused.waypoints.empty());
    EXPECT_NE(refused.message.find("returned"), std::string::npos) << refused.message;
  }
}

/// OMPL's RRTConnect occasionally returns an approximate path that does not begin at the start.
TEST(PlanMotion, RefusesAnApproximateSolutionThatDoesNotBeginAtTheStart)
{
  const PlanningQuery wanted = query({-1.0, 0.0}, {{1.0, 0.0}});
  const PlanningResult good = plan<Lost<false, ob::PlannerStatus::APPROXIMATE_SOLUTION>>({}, wanted);
  EXPECT_EQ(good.status, PlanningStatus::Approximate) << good.message;
  EXPECT_EQ(good.waypoints, (std::vector<std::vector<double>>{{-1.0, 0.0}, {0.0, 0.0}}));
  const PlanningResult wrong = plan<Lost<true, ob::PlannerStatus::APPROXIMATE_SOLUTION>>({}, wanted);
  EXPECT_EQ(wrong.status, PlanningStatus::NoSolution);
  EXPECT_TRUE(wrong.waypoints.empty());
  EXPECT_EQ(wrong.message.find("no solution within"), 0U) << wrong.message;
}

TEST(PlanMotion, SaysIfTheFirstChecksTookMostOfTheTime)
{
  PlanningQuery wanted = query({-1.0, 0.0}, {{1.0, 0.0}});
  wanted.seconds = 1e-6;
  const PlanningResult late = plan<Lost<false, ob::PlannerStatus::TIMEOUT>>({}, wanted);
  EXPECT_NE(late.message.find("no solution within 1e-06 s (Lost: Timeout); checking the start and the goals took"),
            std::string::npos)
      << late.message;
  wanted.seconds = 1000.0;
  const PlanningResult other = plan<Lost<false, ob::PlannerStatus::TIMEOUT>>({}, wanted);
  EXPECT_EQ(other.message.find("checking the start"), std::string::npos) << other.message;
}

TEST(PlanMotion, AnswersAStraightMotionByItsEnds)
{
  const PlanningResult result = plan<BatchRrtConnect>({}, query({-1.0, -1.5}, {{1.0, 1.5}}));
  EXPECT_EQ(result.status, PlanningStatus::Solved);
  EXPECT_EQ(result.waypoints, (std::vector<std::vector<double>>{{-1.0, -1.5}, {1.0, 1.5}}));
}

TEST(PlanMotion, RepeatsAPathForASeed)
{
  const std::vector<Wall> walls = {{-0.5, -3.0, -0.3, 1.7}, {0.3, -1.7, 0.5, 3.0}};
  PlanningQuery wanted = query({-1.0, 0.0}, {{1.0, 0.0}});
  const auto path_of = [&](std::uint32_t seed)
  {
    wanted.seed = seed;
    const PlanningResult result = plan<BatchRrtConnect>(walls, wanted);
    EXPECT_EQ(result.status, PlanningStatus::Solved);
    return result.waypoints;
  };
  const auto path = path_of(7);
  EXPECT_NE(path_of(8), path);
  EXPECT_EQ(path_of(7), path);
  path_of(0);
  EXPECT_EQ(path_of(7), path);
}

class KnownWay : public testing::Test
{
 protected:
  KnownWay()
  {
    there_.known_paths = known_;
    there_.parameters = {{"max_rounds", "1"}};  // the straight motion, and known paths
    there_.seconds = 0.5;                       // for the proof of a path that ends near the goal
  }

  PlanningQuery back() const
  {
    PlanningQuery turned = there_;
    std::swap(turned.start, turned.goals[0]);
    return turned;
  }

  void add(const std::vector<std::vector<double>>& waypoints)
  {
    const PointRobot robot({});
    known_->add(std::make_shared<GroupStateSpace>(robot.scene()->robot, "plane"), waypoints);
  }

  inline static const std::vector<Wall> kTwoGaps = {{-0.5, -3.0, -0.3, 1.7}, {0.3, -1.7, 0.5, 3.0}};
  inline static const std::vector<std::vector<double>> kWay = {{-1.0, 0.0}, {-1.0, 1.9}, {0.0, 1.9},
                                                               {0.0, -1.9}, {1.0, -1.9}, {1.0, 0.0}};
  std::shared_ptr<KnownPaths> known_ = std::make_shared<KnownPaths>(4);
  PlanningQuery there_ = query({-1.0, 0.0}, {{1.0, 0.0}});
};

TEST_F(KnownWay, IsTriedFirstInBothDirections)
{
  EXPECT_NE(plan<BatchRrtConnect>(kTwoGaps, there_).status, PlanningStatus::Solved);
  add(kWay);
  for (const PlanningQuery& wanted : {there_, back()})
  {
    const PlanningResult result = plan<BatchRrtConnect>(kTwoGaps, wanted);
    EXPECT_EQ(result.status, PlanningStatus::Solved) << result.message;
    EXPECT_EQ(result.waypoints.back(), wanted.goals[0]);
  }
}

TEST_F(KnownWay, IsNotTakenWhereTheSceneBlocksIt)
{
  add(kWay);
  std::vector<Wall> walls = kTwoGaps;
  walls.push_back({-0.2, -0.2, 0.2, 0.2});
  EXPECT_NE(plan<BatchRrtConnect>(walls, there_).status, PlanningStatus::Solved);
}

TEST_F(KnownWay, DoesNotChangeThePathOfASeed)
{
  there_.seed = 7;
  there_.parameters.clear();
  there_.seconds = 20.0;
  const auto first = plan<BatchRrtConnect>(kTwoGaps, there_).waypoints;
  add(kWay);
  EXPECT_EQ(plan<BatchRrtConnect>(kTwoGaps, there_).waypoints, first);
}

TEST_F(KnownWay, OfAnotherRobotIsLeftOut)
{
  const auto robot = robotOf(
      "<link name='base'/>" + boxLink("wheel") + jointXml("turn", "continuous", "base", "wheel", "<axis xyz='0 0 1'/>"),
      R"(<group name="plane"><joint name="turn"/></group>)");
  known_->add(std::make_shared<GroupStateSpace>(robot, "plane"), {{0.0}, {1.0}, {2.0}});
  EXPECT_EQ(plan<BatchRrtConnect>({}, there_).status, PlanningStatus::Solved);
  add(kWay);
  EXPECT_EQ(known_->of("plane").size(), 1u);
}

TEST(PlanMotion, CountsTheLookAtStartAndGoals)
{
  const PlanningResult result = plan<BatchRrtConnect>(kWall, query({-1.0, 0.0}, {{0.0, 0.0}, {0.05, 1.0}}));
  EXPECT_EQ(result.status, PlanningStatus::GoalInCollision);
  EXPECT_EQ(result.message.find("goal 0 is in collision: "), 0U) << result.message;
  EXPECT_EQ(result.states_checked, 3U);
  EXPECT_GT(result.checking_seconds, 0.0);
  EXPECT_GE(result.planning_seconds + 1e-6, result.checking_seconds);
}

TEST(PlanMotion, TakesTheGoalsThatAreGood)
{
  const PlanningResult result =
      plan<BatchRrtConnect>(kWall, query({-1.0, 0.0}, {{0.0, 0.0}, {-5.0, 0.0}, {-1.0, 1.0}}));
  EXPECT_EQ(result.status, PlanningStatus::Solved);
  EXPECT_EQ(result.waypoints.back(), (std::vector<double>{-1.0, 1.0}));
}

TEST(PlanMotion, SaysWhatIsOutOfBounds)
{
  const PlanningResult start = plan<BatchRrtConnect>({}, query({-2.5, 0.0}, {{0.0, 0.0}}));
  EXPECT_EQ(start.status, PlanningStatus::OutOfBounds);
  EXPECT_EQ(start.message.find("the start is out of bounds: joint 'x' is -2.5"), 0U) << start.message;
  const PlanningResult goal = plan<BatchRrtConnect>({}, query({0.0, 0.0}, {{0.0, 2.5}}));
  EXPECT_EQ(goal.status, PlanningStatus::OutOfBounds);
  EXPECT_EQ(goal.message.find("the goal is out of bounds: joint 'y' is 2.5"), 0U) << goal.message;
}

/// A wall whose near end is the lower one.
TEST(PlanMotion, OptimizesForAsLongAsAskedUnlessThePathIsStraight)
{
  PlanningQuery wanted = query({-1.0, 0.0}, {{1.0, 0.0}});
  wanted.optimize_seconds = 0.5;
  const std::vector<Wall> walls = {{-0.1, -0.6, 0.1, 1.5}};
  const PlanningResult result = plan<BatchRrtConnect>(walls, wanted);
  ASSERT_EQ(result.status, PlanningStatus::Solved) << result.message;
  EXPECT_GE(result.simplification_seconds, wanted.optimize_seconds);
  for (const std::vector<double>& waypoint : result.waypoints)
    EXPECT_LE(waypoint[1], 0.0) << "round the near end";
  EXPECT_LT(plan<BatchRrtConnect>({}, wanted).simplification_seconds, wanted.optimize_seconds);
  EXPECT_NE(PlanningStatus::Solved, plan<Lost<false>>(walls, wanted).status) << "a path that ends at no goal";
  for (const double seconds : {-1.0, 2e9, std::nan("")})
  {
    wanted.optimize_seconds = seconds;
    EXPECT_NE(std::string::npos,
              errorOf([&] { plan<BatchRrtConnect>(walls, wanted); }).find("the time to optimize is"));
  }
}

/// The stop may come during planning, simplification or the final check of the path.
TEST(PlanMotion, EndsWheneverStopIsTrue)
{
  const std::vector<Wall> walls = {{-0.5, -3.0, -0.3, 1.7}, {0.3, -1.7, 0.5, 3.0}};
  int needed = 0;
  const PlanningQuery wanted = query({-1.0, 0.0}, {{1.0, 0.0}});
  EXPECT_EQ(plan<BatchRrtConnect>(walls, wanted, [&] { return ++needed < 0; }).status, PlanningStatus::Solved);
  for (int last : {1, 2, 5, needed / 4, needed / 2, 3 * needed / 4})
  {
    int asked = 0;
    const auto begin = std::chrono::steady_clock::now();
    const PlanningResult ended = plan<BatchRrtConnect>(walls, wanted, [&] { return ++asked >= last; });
    // The search is random and may end before the stop. After the stop, a path that is proven already is returned.
    EXPECT_TRUE(ended.status == PlanningStatus::Solved || asked >= last) << asked << " of " << needed;
    EXPECT_TRUE(ended.status != PlanningStatus::Solved || last > 5) << asked << " of " << needed;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
  }
}

/// An arm that turns without limits among posts, on a lift that is not planned for.
class Turning : public testing::Test
{
 protected:
  static std::shared_ptr<const RobotModel> robot()
  {
    static const auto made = robotOf(
        "<link name='base'/><link name='mast'/><link name='arm'><collision><origin xyz='0.5 0 0'/><geometry>"
        "<box size='1 0.02 0.02'/></geometry></collision></link>" +
            jointXml("lift", "prismatic", "base", "mast",
                     "<axis xyz='0 0 1'/><limit lower='0' upper='1' effort='1' velocity='1'/>") +
            jointXml("turn", "continuous", "mast", "arm", "<axis xyz='0 0 1'/>"),
        "<group name='round'><joint name='turn'/></group>");
    return made;
  }

  PlanningResult plan(double start, double goal, double lift = 0.5)
  {
    PlanningQuery wanted = query({lift, start}, {{lift, goal}});
    wanted.group = "round";
    return planMotion(scene_, checker_, wanted, PlannerFactoryOf<BatchRrtConnect>());
  }

  void put(double angle)
  {
    auto scene = std::make_shared<PlanningScene>(robot());
    WorldObject post;
    post.id = "post";
    post.pose = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(0.6, 0.0, 0.0);
    post.shapes = {{Box{{0.05, 0.05, 3.0}}}};
    scene->objects = {post};
    scene_ = scene;
    checker_ = std::make_shared<CpuChecker>(scene);
  }

  std::shared_ptr<const PlanningScene> scene_;
  std::shared_ptr<StateChecker> checker_;
};

/// For half a turn, both directions are equally short. The waypoints must show the checked direction.
TEST_F(Turning, WaypointsFollowTheCheckedDirection)
{
  constexpr double kPi = EIGEN_PI;  // EIGEN_PI is a long double
  int solved = 0;
  for (const double post : {0.5 * kPi, -0.5 * kPi, 2.0})
  {
    put(post);
    for (const double offset : {0.0, 0.3, -1.1, 1e-7})
      for (int start = -3; start <= 3; ++start)
        for (const double turn : {kPi, -kPi, 2.9, -1.0})
        {
          const double from = offset + start * kPi;
          const PlanningResult result = plan(from, from + turn);
          if (result.status != PlanningStatus::Solved)
            continue;
          ++solved;
          EXPECT_EQ(result.waypoints.front(), (std::vector<double>{0.5, from}));
          EXPECT_NEAR(std::remainder(result.waypoints.back()[1] - from - turn, 2.0 * kPi), 0.0, 1e-9);
          std::vector<double> followed;
          for (std::size_t i = 0; i + 1 < result.waypoints.size(); ++i)
            for (int k = 0; k <= 500; ++k)
            {
              const double part = k / 500.0;
              followed.push_back(0.5);
              followed.push_back((1.0 - part) * result.waypoints[i][1] + part * result.waypoints[i + 1][1]);
            }
          const std::vector<std::uint8_t> free = checker_->check(followed.data(), followed.size() / 2).valid;
          EXPECT_EQ(std::count(free.begin(), free.end(), 0), 0) << "from " << from << " by " << turn;
        }
  }
  EXPECT_GT(solved, 200);
}

TEST_F(Turning, HasTheMiddleOfHalfATurn)
{
  scene_ = std::make_shared<const PlanningScene>(robot());
  checker_ = std::make_shared<CpuChecker>(scene_);
  EXPECT_EQ(plan(0.3, 0.3 + EIGEN_PI).waypoints.size(), 3U);
  EXPECT_EQ(plan(0.3, 0.2 + EIGEN_PI).waypoints.size(), 2U);
}

TEST_F(Turning, IsRefusedAtAnglesOfMoreTurnsThanDoublesDistinguish)
{
  put(2.0);
  EXPECT_THROW(plan(1e7, 1.0), Error);
  EXPECT_EQ(plan(9e5, 9e5 + 0.1).status, PlanningStatus::Solved);
}

TEST_F(Turning, IsRefusedToAGoalThatMovesAVariableOutsideTheGroup)
{
  put(2.0);
  PlanningQuery wanted = query({0.5, 0.0}, {{0.5, 1.0}, {0.6, 1.0}});
  wanted.group = "round";
  try
  {
    planMotion(scene_, checker_, wanted, PlannerFactoryOf<BatchRrtConnect>());
    FAIL() << "planned";
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(
        error.what(),
        "goal 1: lift is 0.6 and at the start 0.5, but group 'round' does not plan for it; give it the value of "
        "the start");
  }
}

TEST_F(Turning, IsRefusedWhereAnotherJointIsBeyondItsLimits)
{
  put(2.0);
  EXPECT_EQ(plan(0.0, 1.0).status, PlanningStatus::Solved);
  const PlanningResult beyond = plan(0.0, 1.0, 1.5);
  EXPECT_EQ(beyond.status, PlanningStatus::OutOfBounds);
  EXPECT_EQ(beyond.message.find("the start is out of bounds: joint 'lift' is 1.5"), 0U) << beyond.message;
}

TEST(PlanMotion, SuggestsDegreesForAGoalThatTheyWouldFit)
{
  const auto robot =
      robotOf(std::string("<link name='base'/><link name='a'/><link name='b'/>") +
                  jointXml("pan", "revolute", "base", "a", "<limit lower='-1' upper='1' effort='1' velocity='1'/>") +
                  jointXml("tilt", "revolute", "a", "b", "<limit lower='-2' upper='2' effort='1' velocity='1'/>"),
              "<group name='all'><joint name='pan'/><joint name='tilt'/></group>");
  const auto scene = std::make_shared<const PlanningScene>(robot);
  PlanningQuery wanted = query({0.0, 0.0}, {{10.0, 90.0}});
  wanted.group = "all";
  const PlanningResult goal =
      planMotion(scene, std::make_shared<CpuChecker>(scene), wanted, PlannerFactoryOf<BatchRrtConnect>());
  EXPECT_EQ(goal.status, PlanningStatus::OutOfBounds);
  EXPECT_EQ(goal.message,
            "the goal is out of bounds: joint 'pan' is 10, outside its limits -1 to 1 rad; values are in radians, and "
            "joint 'tilt' is 90: 90 degrees are 1.5708 rad; 1 more value is outside the limits");
}

/// The range in which a base is planned for.
class BaseGoals : public testing::Test
{
 public:
  BaseGoals()
  {
    wanted.group = "base";
    wanted.start = {0.0, 0.0, 0.0};
    wanted.goals = {{3.0, 0.0, 0.5}};
    wanted.seconds = 20.0;
  }

  PlanningResult plan(const std::vector<JointLimits>& limits = {}) const
  {
    RobotModelOptions options;
    options.joint_limits = limits;
    const auto robot = RobotModel::fromXml(
        "<robot name='r'>" + boxLink("body") + "</robot>",
        "<robot name='r'><virtual_joint name='drive' type='planar' parent_frame='world' child_link='body'/>"
        "<group name='base'><joint name='drive'/></group></robot>",
        options);
    const auto scene = std::make_shared<const PlanningScene>(robot);
    return planMotion(scene, std::make_shared<CpuChecker>(scene), wanted, PlannerFactoryOf<BatchRrtConnect>());
  }

  static Eigen::AlignedBox3d workspace(double size)
  {
    return {Eigen::Vector3d::Constant(-size), Eigen::Vector3d::Constant(size)};
  }

  PlanningQuery wanted;
};

TEST_F(BaseGoals, BeyondUnboundedTranslationNameTheParameter)
{
  const PlanningResult result = plan();
  EXPECT_EQ(PlanningStatus::OutOfBounds, result.status);
  EXPECT_EQ(
      "the goal is out of bounds: joint 'drive/x' is 3, outside -1 to 1, the range of translations without "
      "limits; set a larger unbounded_translation, or give the request a workspace",
      result.message);
}

TEST_F(BaseGoals, AreReachedWithinTheWorkspaceOfTheRequest)
{
  wanted.workspace = workspace(4.0);
  EXPECT_EQ(PlanningStatus::Solved, plan().status);
  wanted.workspace = workspace(2.0);
  const PlanningResult result = plan();
  EXPECT_EQ(PlanningStatus::OutOfBounds, result.status);
  EXPECT_EQ("the goal is out of bounds: joint 'drive/x' is 3, outside the workspace of the request, -2 to 2",
            result.message);
  wanted.workspace = Eigen::AlignedBox3d(Eigen::Vector3d(1.0, -1.0, 0.0), Eigen::Vector3d(4.0, 1.0, 0.0));
  EXPECT_EQ("the start is out of bounds: joint 'drive/x' is 0, outside the workspace of the request, 1 to 4",
            plan().message);
}

TEST_F(BaseGoals, StayWithinTheLimitsOfTheJoint)
{
  wanted.workspace = workspace(10.0);
  const PlanningResult result = plan({{"drive/x", -2.0, 2.0, "limits.yaml"}});
  EXPECT_EQ(PlanningStatus::OutOfBounds, result.status);
  EXPECT_EQ("the goal is out of bounds: joint 'drive/x' is 3, outside its limits -2 to 2", result.message);
  EXPECT_EQ(PlanningStatus::Solved, plan({{"drive/x", -2.0, 3.5, "limits.yaml"}}).status);
  wanted.workspace.reset();
  EXPECT_EQ(PlanningStatus::Solved, plan({{"drive/x", -2.0, 3.5, "limits.yaml"}}).status);
}

TEST_F(BaseGoals, BeyondAMillionRadiansAreRefused)
{
  wanted.goals = {{0.0, 0.0, 2e9}};
  EXPECT_EQ("goal 0: drive/theta is 2e+09 rad; it must be from -1e6 to 1e6", errorOf([this] { plan(); }));
}

/// A body that moves in the plane, and a body that floats.
class Moving : public testing::TestWithParam<const char*>
{
 protected:
  PlanningResult plan(const std::vector<double>& start, const std::vector<double>& goal)
  {
    const auto robot = robotOf(boxLink("base") + "<link name='body'/>" + jointXml("move", GetParam(), "base", "body"),
                               "<group name='all'><joint name='move'/></group>");
    const auto scene = std::make_shared<const PlanningScene>(robot);
    PlanningQuery wanted = query(start, {goal});
    wanted.group = "all";
    return planMotion(scene, std::make_shared<CpuChecker>(scene), wanted, PlannerFactoryOf<BatchRrtConnect>());
  }

  std::vector<double> at(double x, double angle) const
  {
    if (std::string(GetParam()) == "planar")
      return {x, 0.0, angle};
    return {x, 0.0, 0.0, 0.0, 0.0, std::sin(0.5 * angle), std::cos(0.5 * angle)};
  }
};

TEST_P(Moving, NamesTheTranslationThatIsOutOfBounds)
{
  const PlanningResult goal = plan(at(0.0, 0.0), at(1.5, 0.0));  // the default bound of unlimited translations is 1 m
  EXPECT_EQ(goal.status, PlanningStatus::OutOfBounds);
  EXPECT_EQ(goal.message.find("the goal is out of bounds: joint 'move/"), 0U) << goal.message;
  EXPECT_NE(goal.message.find("x' is 1.5"), std::string::npos) << goal.message;
  EXPECT_EQ(plan(at(-1.5, 0.0), at(0.0, 0.0)).status, PlanningStatus::OutOfBounds);
}

TEST_P(Moving, TurnsOnWithoutJumps)
{
  const std::vector<double> start = at(0.0, 7.0);
  const PlanningResult result = plan(start, at(0.5, 8.0 - 4.0 * EIGEN_PI));
  ASSERT_EQ(result.status, PlanningStatus::Solved);
  EXPECT_EQ(result.waypoints.front(), start);
  const std::vector<double> expected = at(0.5, 8.0);
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(result.waypoints.back()[i], expected[i], 1e-9) << i;
}

INSTANTIATE_TEST_SUITE_P(Joints, Moving, testing::Values("planar", "floating"));

TEST(PlanMotion, RefusesInvalidQueries)
{
  EXPECT_THROW(plan<BatchRrtConnect>({}, query({-1.0}, {{1.0, 0.0}})), Error);
  EXPECT_THROW(plan<BatchRrtConnect>({}, query({-1.0, 0.0}, {})), Error);
  EXPECT_THROW(plan<BatchRrtConnect>({}, query({-1.0, 0.0}, {{1.0, std::numeric_limits<double>::quiet_NaN()}})), Error);
  PlanningQuery wanted = query({-1.0, 0.0}, {{1.0, 0.0}});
  wanted.parameters["branches"] = "many";
  EXPECT_THROW(plan<BatchRrtConnect>({}, wanted), Error);
  wanted.parameters = {{"twigs", "3"}};
  EXPECT_THROW(plan<BatchRrtConnect>({}, wanted), Error);
  wanted.parameters.clear();
  for (const double seconds : {0.0, -1.0, 1e10, std::numeric_limits<double>::infinity()})
  {
    wanted.seconds = seconds;
    EXPECT_THROW(plan<BatchRrtConnect>({}, wanted), Error) << seconds;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
