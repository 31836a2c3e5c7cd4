#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <ompl/base/goals/GoalStates.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "moveit/planner/planning_context.h"
#include "moveit/planner/preparation.h"
#include "moveit/planner_fixtures.h"

// A planning context with a planner and a checker of the test.
namespace gpu_planning_scene::pipeline
{
namespace
{
using moveit_msgs::MoveItErrorCodes;

/// Drives from the start to the first goal, and on its way along a given y.
class Detour : public ompl::base::Planner
{
 public:
  Detour(const ompl::base::SpaceInformationPtr& information, double y) : Planner(information, "Detour"), y_(y) {}

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition&) override
  {
    const auto& space = *si_->getStateSpace()->as<core::GroupStateSpace>();
    const auto path = std::make_shared<ompl::geometric::PathGeometric>(si_, pdef_->getStartState(0));
    for (const double x : {1.0, 3.0})
    {
      ompl::base::ScopedState<> state(si_);
      const double row[] = {x, y_, 0.0};
      space.copyFromRow(row, state.get());
      path->append(state.get());
    }
    path->append(pdef_->getGoal()->as<ompl::base::GoalStates>()->getState(0));
    pdef_->addSolutionPath(path);
    return ompl::base::PlannerStatus::EXACT_SOLUTION;
  }

 private:
  const double y_;
};

/// Its planners take one detour after the other.
struct Detours : core::PlannerFactory
{
  explicit Detours(std::vector<double> all) : detours(std::move(all)) {}

  ompl::base::PlannerPtr create(const ompl::base::SpaceInformationPtr& information) const override
  {
    return std::make_shared<Detour>(information, detours.at(created++));
  }

  const std::vector<double> detours;
  mutable std::size_t created = 0;
};

/// Waits until it has to end. Then it has no path, or one that ends before the goal.
class Waiting : public ompl::base::Planner
{
 public:
  Waiting(const ompl::base::SpaceInformationPtr& information, bool has_a_part, std::promise<void>& begun)
    : Planner(information, "Waiting"), has_a_part_(has_a_part), begun_(begun)
  {
  }

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& has_to_end) override
  {
    begun_.set_value();
    while (!has_to_end)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (!has_a_part_)
      return ompl::base::PlannerStatus::TIMEOUT;
    const auto& space = *si_->getStateSpace()->as<core::GroupStateSpace>();
    ompl::base::ScopedState<> state(si_);
    const double row[] = {1.0, 0.0, 0.0};
    space.copyFromRow(row, state.get());
    const auto path = std::make_shared<ompl::geometric::PathGeometric>(si_, pdef_->getStartState(0), state.get());
    pdef_->addSolutionPath(path, true, 3.0);
    return ompl::base::PlannerStatus::APPROXIMATE_SOLUTION;
  }

 private:
  const bool has_a_part_;
  std::promise<void>& begun_;
};

struct WaitingPlanners : core::PlannerFactory
{
  explicit WaitingPlanners(bool part) : has_a_part(part) {}

  ompl::base::PlannerPtr create(const ompl::base::SpaceInformationPtr& information) const override
  {
    return std::make_shared<Waiting>(information, has_a_part, begun);
  }

  const bool has_a_part;
  mutable std::promise<void> begun;
};

/// Gives up at once.
class GivingUp : public ompl::base::Planner
{
 public:
  explicit GivingUp(const ompl::base::SpaceInformationPtr& information) : Planner(information, "GivingUp") {}

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition&) override
  {
    return ompl::base::PlannerStatus::ABORT;
  }
};

/// A checker that needs a time of preparation in its first check, as a device needs it for its shaders.
class SlowAtFirst : public core::CpuChecker
{
 public:
  SlowAtFirst(std::shared_ptr<const core::PlanningScene> scene, std::chrono::milliseconds preparation)
    : CpuChecker(std::move(scene)), preparation_(preparation)
  {
  }

  core::BatchResult checkBatch(const core::StateBatch& batch) override
  {
    std::this_thread::sleep_for(std::exchange(preparation_, std::chrono::milliseconds(0)));
    return CpuChecker::checkBatch(batch);
  }

 private:
  std::chrono::milliseconds preparation_;
};

/// Counts its checks with and without neighbourhoods.
class Counting : public core::CpuChecker
{
 public:
  struct Counts
  {
    int plain = 0;
    int around = 0;
  };

  Counting(std::shared_ptr<const core::PlanningScene> scene, Counts& counts)
    : CpuChecker(std::move(scene)), counts_(counts)
  {
  }

  core::BatchResult checkBatch(const core::StateBatch& batch) override
  {
    ++(batch.around ? counts_.around : counts_.plain);
    return CpuChecker::checkBatch(batch);
  }

 private:
  Counts& counts_;
};

class Context : public Cart
{
 protected:
  std::unique_ptr<PlanningContext> contextOf(const std::shared_ptr<const core::PlannerFactory>& factory,
                                             const std::shared_ptr<Workshop>& workshop) const
  {
    auto context = std::make_unique<PlanningContext>(
        "cart", PlannerChoice{"planner of the test", factory, {}, {}, std::nullopt, 0.0}, workshop);
    context->setPlanningScene(scene_);
    context->setMotionPlanRequest(request_);
    return context;
  }

  int planWith(const std::shared_ptr<const core::PlannerFactory>& factory, const std::shared_ptr<Workshop>& workshop)
  {
    contextOf(factory, workshop)->solve(response_);
    return response_.error_code_.val;
  }

  static std::shared_ptr<Workshop> onCpu()
  {
    return std::make_shared<Workshop>([](const std::shared_ptr<const core::PlanningScene>& scene)
                                      { return std::make_shared<core::CpuChecker>(scene); });
  }
};

TEST_F(Context, ReturnsTheShortestPathOfSeveralAttempts)
{
  // The way around the wall is shorter where y is negative.
  scene_->getWorldNonConst()->addToObject("wall", at(2.0, 1.0, 0.0), box(0.2, 4.0, 1.0), Eigen::Isometry3d::Identity());
  const std::shared_ptr<Workshop> workshop = onCpu();
  request_.num_planning_attempts = 3;
  for (const std::vector<double>& detours :
       {std::vector<double>{4.0, -2.0, 4.0}, std::vector<double>{-2.0, 4.0, 4.0}, std::vector<double>{4.0, 4.0, -2.0}})
  {
    const auto factory = std::make_shared<const Detours>(detours);
    ASSERT_EQ(int(MoveItErrorCodes::SUCCESS), planWith(factory, workshop));
    EXPECT_EQ(3U, factory->created);
    for (std::size_t i = 0; i < response_.trajectory_->getWayPointCount(); ++i)
      EXPECT_LE(response_.trajectory_->getWayPoint(i).getVariablePosition("drive/y"), 0.1);
  }
}

TEST_F(Context, APlannerWithoutAPathToTheGoalInTimeGivesNoPath)
{
  request_.allowed_planning_time = 2.0;
  for (const bool has_a_part : {false, true})
  {
    const auto factory = std::make_shared<WaitingPlanners>(has_a_part);
    EXPECT_EQ(int(MoveItErrorCodes::TIMED_OUT), planWith(factory, onCpu()));
    EXPECT_FALSE(response_.trajectory_);
    EXPECT_EQ(std::future_status::ready, factory->begun.get_future().wait_for(std::chrono::seconds(0)))
        << "the time ended before the planner began";
  }
}

TEST_F(Context, APlannerThatGivesUpBeforeTheTimeEndsHasFailed)
{
  EXPECT_EQ(int(MoveItErrorCodes::PLANNING_FAILED),
            planWith(std::make_shared<core::PlannerFactoryOf<GivingUp>>(), onCpu()));
  EXPECT_FALSE(response_.trajectory_);
}

TEST_F(Context, TerminatingEndsAPlannerThatRunsInAnotherThread)
{
  request_.allowed_planning_time = 60.0;
  for (const bool has_a_part : {false, true})
  {
    const auto factory = std::make_shared<WaitingPlanners>(has_a_part);
    const std::unique_ptr<PlanningContext> context = contextOf(factory, onCpu());
    std::thread terminating(
        [&]
        {
          factory->begun.get_future().wait();
          context->terminate();
        });
    EXPECT_FALSE(context->solve(response_));
    terminating.join();
    EXPECT_EQ(int(MoveItErrorCodes::PREEMPTED), response_.error_code_.val);
    EXPECT_FALSE(response_.trajectory_);
    EXPECT_LT(response_.planning_time_, 30.0);
  }
}

TEST_F(Context, ThePreparedCheckerServesTheFirstRequest)
{
  int made = 0;
  Counting::Counts counts;
  const auto workshop = std::make_shared<Workshop>(
      [&](const std::shared_ptr<const core::PlanningScene>& scene)
      {
        ++made;
        return std::make_shared<Counting>(scene, counts);
      });
  prepareChecker(*workshop, robot_);
  EXPECT_EQ(1, made);
  EXPECT_LT(0, counts.plain);
  EXPECT_LT(0, counts.around);
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), planWith(std::make_shared<Detours>(std::vector<double>{0.0}), workshop));
  EXPECT_EQ(1, made);
}

TEST_F(Context, ARequestWithoutTimeKeepsThePreparedCheckerForTheNextOne)
{
  std::atomic<int> made{0};
  const auto workshop = std::make_shared<Workshop>(
      [&made](const std::shared_ptr<const core::PlanningScene>& scene)
      {
        ++made;
        return std::make_shared<SlowAtFirst>(scene, std::chrono::milliseconds(400));
      });
  request_.allowed_planning_time = 0.2;
  EXPECT_EQ(int(MoveItErrorCodes::TIMED_OUT), planWith(std::make_shared<Detours>(std::vector<double>{0.0}), workshop));
  request_.allowed_planning_time = 20.0;
  EXPECT_EQ(int(MoveItErrorCodes::SUCCESS), planWith(std::make_shared<Detours>(std::vector<double>{0.0}), workshop));
  EXPECT_EQ(1, made);
}
}  // namespace
}  // namespace gpu_planning_scene::pipeline
