// What planMotion answers, whatever its planner does.

#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "planning/point_robot.h"

namespace gpu_planning_scene
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;

const std::vector<Wall> kWall = {{-0.1, -3.0, 0.1, 3.0}};

template <class Planner>
class Factory : public PlannerFactory
{
 public:
  ob::PlannerPtr create(const ob::SpaceInformationPtr& information) const override
  {
    return std::make_shared<Planner>(information);
  }
};

/// Goes straight to the goal, and asks nobody.
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
  return planMotion(robot.scene(), robot.checker(), query, Factory<Planner>(), stop);
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

TEST(PlanMotion, AnswersAStraightWayByItsEnds)
{
  const PlanningResult result = plan<BatchRrtConnect>({}, query({-1.0, -1.5}, {{1.0, 1.5}}));
  EXPECT_EQ(result.status, PlanningStatus::Solved);
  EXPECT_EQ(result.waypoints, (std::vector<std::vector<double>>{{-1.0, -1.5}, {1.0, 1.5}}));
}

TEST(PlanMotion, CountsTheLookAtStartAndGoals)
{
  const PlanningResult result = plan<BatchRrtConnect>(kWall, query({-1.0, 0.0}, {{0.0, 0.0}, {0.05, 1.0}}));
  EXPECT_EQ(result.status, PlanningStatus::GoalsInCollision);
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
  EXPECT_EQ(start.message.find("the start is out of bounds: x is -2.5"), 0U) << start.message;
  const PlanningResult goal = plan<BatchRrtConnect>({}, query({0.0, 0.0}, {{0.0, 2.5}}));
  EXPECT_EQ(goal.status, PlanningStatus::OutOfBounds);
  EXPECT_EQ(goal.message.find("the goal is out of bounds: y is 2.5"), 0U) << goal.message;
}

TEST(PlanMotion, EndsWhenItIsToldTo)
{
  EXPECT_EQ(plan<BatchRrtConnect>({}, query({-1.0, 0.0}, {{1.0, 0.0}}), [] { return true; }).status,
            PlanningStatus::NoSolution);
}

TEST(PlanMotion, RefusesWhatIsNoQuery)
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
  wanted.seconds = 0.0;
  EXPECT_THROW(plan<BatchRrtConnect>({}, wanted), Error);
}
}  // namespace
}  // namespace gpu_planning_scene
