// The batch size from which a method with a slow start is the faster one.
#include "collision/checkers/cpu_or_gpu.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Work that reports a constant time plus a time for each item. `spent` sums the reported times.
TimedWork work(double fixed, double per_item, double* spent = nullptr)
{
  return [=](std::size_t size)
  {
    const double seconds = fixed + per_item * static_cast<double>(size);
    if (spent)
      *spent += seconds;
    return seconds;
  };
}

TEST(BreakEven, IsWhereOneIsClearlyFaster)
{
  EXPECT_NEAR(static_cast<double>(breakEven(work(2e-6, 4e-6), work(202e-6, 2e-6))), 150.0, 2.0);  // 240 + 2.4 n = 4 n
  EXPECT_NEAR(static_cast<double>(breakEven(work(0.0, 10e-6), work(1e-3, 0.0))), 120.0, 1.0);
  EXPECT_EQ(breakEven(work(1e-6, 10e-6), work(1e-6, 9e-6)), kNoBatch);
}

TEST(BreakEven, IsNoneWhereOneIsFasterAlways)
{
  EXPECT_EQ(breakEven(work(1e-6, 1e-6), work(1e-3, 2e-6)), kNoBatch);
  EXPECT_EQ(breakEven(work(1e-6, 3e-6), work(1e-6, 2e-6)), 0U);
}

TEST(BreakEven, IsBelievedBeyondWhatWasTimedOnlyOfMuchSmallerCosts)
{
  EXPECT_NEAR(static_cast<double>(breakEven(work(1e-6, 1e-6), work(2e-3, 0.1e-6))), 2726.0,
              30.0);  // 2400 + .12 n = 1 + n
  EXPECT_EQ(breakEven(work(1e-6, 1e-6), work(2e-3, 0.7e-6)), kNoBatch);
}

TEST(BreakEven, LooksAtLargerBatchesWhereSmallOnesAreAlike)
{
  // Faster at first because lanes are idle, but not for larger batches.
  const TimedWork lanes = [](std::size_t size)
  { return 1e-6 + (size <= 64 ? 0.0 : 4e-6 * static_cast<double>(size - 64)); };
  EXPECT_EQ(breakEven(work(2e-6, 2e-6), lanes), kNoBatch);
}

TEST(BreakEven, DoesNotBelieveOneDisturbedRun)
{
  // The first method is the faster one, but its first run at each size was disturbed.
  std::size_t last = 0;
  const TimedWork disturbed = [last](std::size_t size) mutable
  {
    const bool first = size != last;
    last = size;
    return (first ? 50e-3 : 0.0) + 2e-6 * static_cast<double>(size);
  };
  EXPECT_EQ(breakEven(disturbed, work(10e-3, 4e-6)), kNoBatch);
}

TEST(BreakEven, DoesNotBelieveThatASmallBatchTakesLongerThanALargeOne)
{
  // All runs of 16 states were disturbed, as on a busy machine.
  const TimedWork disturbed = [](std::size_t size) { return size == 16 ? 4e-3 : 1e-4; };
  EXPECT_LT(breakEven(work(0.0, 1e-5), disturbed), 50U);
}

TEST(BreakEven, TimesNoLargeBatchThatWouldTakeSeconds)
{
  double spent = 0.0;
  breakEven(work(0.0, 1e-4, &spent), work(2e-3, 1e-3, &spent));
  EXPECT_LT(spent, 0.3);
}

TEST(BreakEven, LooksAtALargeBatchEvenIfSmallOnesTakeLong)
{
  // Direct work whose time hardly grows beyond 16 items, for example because more cores take part.
  const TimedWork direct = [](std::size_t size)
  { return 10e-6 * static_cast<double>(std::min<std::size_t>(size, 16)) + 1e-7 * static_cast<double>(size); };
  EXPECT_EQ(breakEven(direct, work(6e-3, 5e-6)), kNoBatch);
}

TEST(BreakEven, TakesLittleTime)
{
  double spent = 0.0;
  breakEven(work(2e-6, 5e-6, &spent), work(3e-3, 10e-6, &spent));
  EXPECT_LT(spent, 0.05);
}

TEST(BreakEven, IsMeasuredForASceneAndChangesNoAnswer)
{
  auto scene = std::make_shared<PlanningScene>(
      robotOf(boxLink("a") + boxLink("b") +
              jointXml("slide", "prismatic", "a", "b", std::string("<axis xyz='1 0 0'/>") + kLimits)));
  scene->allowed_collisions = AllowedCollisionMatrix();
  std::vector<double> states;
  constexpr std::size_t kStates = 10000;
  for (std::size_t i = 0; i < kStates; ++i)
    states.push_back(-1.0 + 0.0003 * static_cast<double>(i));
  BatchChecker checker(scene);
  ASSERT_TRUE(checker.report().cpu_below);
  const std::vector<std::uint8_t> expected = CpuChecker(scene).check(states.data(), kStates).valid;
  EXPECT_EQ(checker.check(states.data(), kStates).valid, expected);
  for (std::size_t i = 0; i < kStates; i += 999)
    EXPECT_EQ(checker.check(&states[i], 1).valid[0], expected[i]);
}

/// A choice between two checks. The CPU's check takes `cpu_seconds` per state.
class Choice : public testing::Test
{
 protected:
  std::size_t threshold(ProofStage proofs)
  {
    const auto wait = [this](double seconds)
    {
      ++runs_;
      const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
      while (std::chrono::steady_clock::now() < end)
        continue;
    };
    const CpuOrGpu::Checks checks{[&](const double*, std::size_t count) { wait(cpu_seconds_ * double(count)); },
                                  [&](const double*, std::size_t) { wait(gpu_seconds_); }};
    CollisionProblem problem;
    problem.self_pairs.resize(pairs_);
    return choice_.choose("", scene_, problem, nullptr, 0, proofs, checks).threshold.value();
  }

  CpuOrGpu choice_{std::nullopt};
  double cpu_seconds_ = 1e-5;
  double gpu_seconds_ = 2e-4;
  std::size_t pairs_ = 10;
  int runs_ = 0;
  std::shared_ptr<const PlanningScene> scene_ = std::make_shared<PlanningScene>(robotOf(boxLink("a")));
};

TEST(ChoiceOfDevice, FollowsTheFixedThresholdUnlessEveryStateCollides)
{
  CpuOrGpu choice(10);
  const auto scene = std::make_shared<PlanningScene>(robotOf(boxLink("a")));
  CollisionProblem problem;
  const auto is_for_cpu = [&](std::size_t count)
  { return choice.choose("", scene, problem, nullptr, count, ProofStage::None, {}).is_for_cpu; };
  EXPECT_TRUE(is_for_cpu(9));
  EXPECT_FALSE(is_for_cpu(10));
  EXPECT_EQ(choice.choose("", scene, problem, nullptr, 10, ProofStage::None, {}).threshold, std::size_t{10});
  problem.always_colliding = BodyPair{0, 1};
  EXPECT_TRUE(is_for_cpu(10));
  EXPECT_FALSE(choice.choose("", scene, problem, nullptr, 10, ProofStage::None, {}).threshold);
}

TEST_F(Choice, IsMeasuredAnewOnceThereAreMoreProofs)
{
  const std::size_t before = threshold(ProofStage::None);
  EXPECT_LT(before, 1000U);
  cpu_seconds_ = 1e-9;
  EXPECT_EQ(threshold(ProofStage::None), before);
  const std::size_t after = threshold(ProofStage::Covers);
  EXPECT_GT(after, 1000U);
  const int runs = runs_;
  EXPECT_EQ(threshold(ProofStage::Covers), after);
  EXPECT_EQ(threshold(ProofStage::None), after);  // a new scene has no proofs at first: not measured again
  EXPECT_EQ(runs_, runs);
  threshold(ProofStage::All);
  EXPECT_GT(runs_, runs);
}

TEST_F(Choice, IsSoonMeasuredAnewInASceneOfAnotherSizeButNotInASimilarOne)
{
  cpu_seconds_ = 1e-6;
  gpu_seconds_ = 1e-4;
  const auto start = std::chrono::steady_clock::now();
  threshold(ProofStage::None);
  const auto pause = 60 * (std::chrono::steady_clock::now() - start);
  const int runs = runs_;
  const auto change_scene = [&](std::size_t pairs)
  {
    scene_ = std::make_shared<PlanningScene>(*scene_);
    pairs_ = pairs;
    threshold(ProofStage::None);
  };
  change_scene(1000);
  EXPECT_EQ(runs_, runs) << "right after a measurement";
  std::this_thread::sleep_for(pause);
  for (const std::size_t pairs : {10, 18, 6})
    change_scene(pairs);
  EXPECT_EQ(runs_, runs) << "similar scenes";
  change_scene(21);
  EXPECT_GT(runs_, runs);
}
}  // namespace
}  // namespace gpu_planning_scene::core
