// Several searches side by side (also with the thread sanitizer): the first solution ends them all, and an exception of
// one of them reaches the caller.

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include <ompl/base/PlannerData.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/goals/GoalSampleableRegion.h>

#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "planning/point_robot.h"
#include "planning/search/rrt_searches.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

/// Two walls, each with a gap at a different end.
const std::vector<Wall> kZigzag = {{-0.5, -3.0, -0.3, 1.7}, {0.3, -1.7, 0.5, 3.0}};
const std::vector<Wall> kBarrier = {{-0.1, -3.0, 0.1, 3.0}};

class RrtSearchesTest : public testing::Test
{
 protected:
  /// Runs the searches. The first one waits before each round, so it hardly goes on.
  RrtSearch::Path run(const std::vector<Wall>& walls, std::size_t count, std::size_t max_rounds,
                      const ob::PlannerTerminationCondition& ptc)
  {
    robot_ = std::make_unique<PointRobot>(walls);
    problem_ = robot_->problem({-1.0, 0.0}, {{1.0, 0.0}});
    planner_ = std::make_unique<BatchRrtConnect>(robot_->information());
    searches_ = std::make_unique<RrtSearches>(*planner_);
    auto* goal = problem_->getGoal()->as<ob::GoalSampleableRegion>();
    const ob::ScopedState<> end = robot_->at({1.0, 0.0});
    searches_->first().trees().addRoot(BidirectionalTree::Start, problem_->getStartState(0));
    searches_->first().trees().addRoot(BidirectionalTree::Goal, end.get());
    const RrtSearches::Options options{count, max_rounds, {64, 0.2, 1e9}};
    return searches_->run(
        robot_->validator(), *goal, options,
        [this]
        {
          ++rounds_of_first_;
          std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms_));
        },
        ptc);
  }

  int wait_ms_ = 0;
  std::size_t rounds_of_first_ = 0;
  std::unique_ptr<PointRobot> robot_;
  ob::ProblemDefinitionPtr problem_;
  std::unique_ptr<BatchRrtConnect> planner_;
  std::unique_ptr<RrtSearches> searches_;
};

TEST_F(RrtSearchesTest, EndWithTheSolutionOfAnyOfThem)
{
  wait_ms_ = 200;
  const RrtSearch::Path path = run(kZigzag, 3, 0, ob::timedPlannerTerminationCondition(60.0));
  ASSERT_TRUE(path);
  EXPECT_TRUE(robot_->isValid(*path));
  EXPECT_EQ(PointRobot::positionOf(path->getStates().front()), PointRobot::Position(-1.0, 0.0));
  EXPECT_EQ(PointRobot::positionOf(path->getStates().back()), PointRobot::Position(1.0, 0.0));
  EXPECT_LT(rounds_of_first_, 12U) << "it did not end with the solution of another search";
  // The exported trees are those of the solution.
  ob::PlannerData data(robot_->information());
  searches_->addTo(data);
  EXPECT_GE(data.numVertices(), path->getStateCount());
}

TEST_F(RrtSearchesTest, EndWithTheTimeOrTheRoundsOfTheFirst)
{
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(run(kBarrier, 3, 0, ob::timedPlannerTerminationCondition(0.2)));
  EXPECT_FALSE(run(kBarrier, 3, 20, ob::timedPlannerTerminationCondition(60.0)));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST_F(RrtSearchesTest, GrowNoTreeWhileAnotherSearchProvesItsPathAndEndInTime)
{
  robot_ = std::make_unique<PointRobot>(kBarrier);
  problem_ = robot_->problem({-1.0, 0.0}, {{1.0, 0.0}});
  planner_ = std::make_unique<BatchRrtConnect>(robot_->information());
  Turn proofs;
  RrtSearch search(*planner_, proofs);
  const ob::ScopedState<> end = robot_->at({1.0, 0.0});
  search.trees().addRoot(BidirectionalTree::Start, problem_->getStartState(0));
  search.trees().addRoot(BidirectionalTree::Goal, end.get());
  const auto vertices = [&] { return search.trees().tree(BidirectionalTree::Start).size(); };
  const auto run_rounds = [&](double seconds)
  {
    const ob::PlannerTerminationCondition ptc = ob::timedPlannerTerminationCondition(seconds);
    for (int i = 0; i < 8; ++i)
      search.runRound(robot_->validator(), *problem_->getGoal()->as<ob::GoalSampleableRegion>(), {64, 0.2, 1e9}, ptc);
  };
  ASSERT_TRUE(proofs.takeFor(std::chrono::milliseconds(0)));
  run_rounds(0.05);
  EXPECT_EQ(vertices(), 1U);
  proofs.give();
  run_rounds(60.0);
  EXPECT_GT(vertices(), 1U);
}

TEST_F(RrtSearchesTest, AreOneSearchIfTheirNumberIsOne)
{
  rounds_of_first_ = 0;
  EXPECT_FALSE(run(kBarrier, 1, 20, ob::timedPlannerTerminationCondition(60.0)));
  EXPECT_EQ(rounds_of_first_, 20U);
}

/// Makes proofs slow, and counts the checks that begin meanwhile.
class SlowProofs : public StateChecker
{
 public:
  explicit SlowProofs(std::shared_ptr<StateChecker> checker) : checker_(std::move(checker)) {}
  void setScene(std::shared_ptr<const PlanningScene> scene) override { checker_->setScene(std::move(scene)); }
  BatchResult checkBatch(const StateBatch& batch) override
  {
    if (!batch.around)
    {
      checks_beside_proofs += proofs_ != 0 ? 1 : 0;
      return checker_->checkBatch(batch);
    }
    ++proofs;
    proofs_beside_proofs += proofs_++ != 0 ? 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    BatchResult result = checker_->checkBatch(batch);
    --proofs_;
    return result;
  }
  SceneReport report(const std::string& group) override { return checker_->report(group); }
  std::string deviceName() const override { return checker_->deviceName(); }
  bool checksSideBySide() const override { return true; }

  std::atomic<int> proofs{0};
  std::atomic<int> proofs_beside_proofs{0};
  std::atomic<int> checks_beside_proofs{0};

 private:
  std::atomic<int> proofs_{0};  // that are in progress
  std::shared_ptr<StateChecker> checker_;
};

TEST(ParallelBatchRrtConnect, ProvesOnePathAtATimeWhileItsOtherSearchesWait)
{
  MotionCheckerOptions options;
  options.rule = MotionRule::Bound;
  const PointRobot robot(kZigzag, options);
  const auto checker = std::make_shared<SlowProofs>(robot.checker());
  robot.information()->setMotionValidator(
      std::make_shared<MotionValidator>(robot.information(), robot.scene(), checker, options));
  robot.information()->setup();
  BatchRrtConnect planner(robot.information());
  planner.setSearches(4);
  planner.setProblemDefinition(robot.problem({-1.0, 0.0}, {{1.0, 0.0}}));
  planner.setup();
  EXPECT_TRUE(planner.Planner::solve(60.0));
  EXPECT_GT(checker->proofs, 0);
  EXPECT_EQ(checker->proofs_beside_proofs, 0);
  // Each of the other searches ends the round that it has begun, which checks its samples in several batches.
  constexpr int kBatchesOfARound = 8;
  EXPECT_LE(checker->checks_beside_proofs, 3 * kBatchesOfARound * checker->proofs);
}

/// Its checks fail on all threads but the one that made it.
class FailingElsewhere : public StateChecker
{
 public:
  explicit FailingElsewhere(std::shared_ptr<StateChecker> checker) : checker_(std::move(checker)) {}
  void setScene(std::shared_ptr<const PlanningScene> scene) override { checker_->setScene(std::move(scene)); }
  BatchResult checkBatch(const StateBatch& batch) override
  {
    if (std::this_thread::get_id() != home_)
      throw std::runtime_error("the device is lost");
    return checker_->checkBatch(batch);
  }
  SceneReport report(const std::string& group) override { return checker_->report(group); }
  std::string deviceName() const override { return checker_->deviceName(); }
  bool checksSideBySide() const override { return true; }

 private:
  std::thread::id home_ = std::this_thread::get_id();
  std::shared_ptr<StateChecker> checker_;
};

TEST(ParallelBatchRrtConnect, ThrowsWhatASearchThrows)
{
  const PointRobot robot(kBarrier);
  robot.information()->setMotionValidator(std::make_shared<MotionValidator>(
      robot.information(), robot.scene(), std::make_shared<FailingElsewhere>(robot.checker())));
  robot.information()->setup();
  BatchRrtConnect planner(robot.information());
  planner.setSearches(2);
  planner.setProblemDefinition(robot.problem({-1.0, 0.0}, {{1.0, 0.0}}));
  planner.setup();
  EXPECT_THROW(planner.Planner::solve(60.0), std::runtime_error);
}
}  // namespace
}  // namespace gpu_planning_scene::core
