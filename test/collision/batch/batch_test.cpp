// Each state of a batch is answered once, whoever takes it and whatever happens to the devices.

#include <atomic>
#include <future>
#include <numeric>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "collision/batch/batch.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kAny = 1'000'000;

class BatchParts : public testing::Test
{
 protected:
  static std::shared_ptr<Batch> batchOf(std::size_t count, const std::vector<std::size_t>& only_cores = {},
                                        std::size_t cores = 2)
  {
    const auto batch = std::make_shared<Batch>(count, std::nullopt, cores);
    DeviceRows rows;
    rows.only_cores.assign(only_cores.empty() ? 0 : count, 0);
    for (const std::size_t row : only_cores)
      rows.only_cores[row] = 1;
    batch->setDeviceRows(std::move(rows));
    return batch;
  }
};

TEST_F(BatchParts, OfCoresAreSmallAndBecomeSmaller)
{
  const auto batch = batchOf(10'000);
  std::size_t last = kAny;
  std::size_t next = 0;
  for (StateRange part = batch->takeForCore(kAny); part.count != 0; part = batch->takeForCore(kAny))
  {
    EXPECT_EQ(part.begin, next);
    EXPECT_LE(part.count, last);
    EXPECT_LE(part.count, 1'250U) << "an eighth, as there are two cores";
    last = part.count;
    next = part.end();
    batch->answered(part);
  }
  EXPECT_EQ(next, 10'000U);
  EXPECT_LE(last, 32U);
  EXPECT_TRUE(batch->isComplete());
}

TEST_F(BatchParts, OfDevicesHaveTheirShareOfWhatWaits)
{
  const auto batch = batchOf(100'000);
  EXPECT_EQ(batch->takeForDevice(7, kAny, 0.5).count, 0U) << "before it has joined";
  batch->join(7);
  EXPECT_EQ(batch->takeForDevice(7, kAny, 0.5).count, 50'000U);
  EXPECT_EQ(batch->takeForDevice(7, 3'000, 0.5).count, 3'000U);
  EXPECT_EQ(batch->takeForDevice(7, kAny, 0.1).count, 4'700U);
  batch->letCoresHelp(false);
  EXPECT_EQ(batch->takeForDevice(7, kAny, 0.1).count, 42'300U) << "nobody else works";
}

TEST_F(BatchParts, OfACoreHaveAtMostAsManyStatesAsItWants)
{
  EXPECT_EQ(batchOf(10'000)->takeForCore(8).count, 8U);
}

TEST_F(BatchParts, ThatOnlyCoresCanCheckHaveNoAnswerOfADevice)
{
  const auto batch = batchOf(10, {0, 3, 4, 9});
  batch->join(1);
  batch->letCoresHelp(false);
  const StateRange part = batch->takeForDevice(1, kAny, 1.0);
  const StateRange mine = batch->beginAnswer(1, part);
  ASSERT_EQ(mine.count, 10U);
  batch->result().valid[3] = 0;
  batch->result().colliding[3] = {1, 2};
  batch->endAnswer(mine, {4, 5});
  EXPECT_EQ(batch->answeredCount(), 5U);
  std::vector<int> by_cores(10, 0);
  for (StateRange own = batch->takeForCore(kAny); own.count != 0; own = batch->takeForCore(kAny))
  {
    for (std::size_t i = own.begin; i < own.end(); ++i)
      ++by_cores[i];
    batch->answered(own);
  }
  EXPECT_EQ(by_cores, (std::vector<int>{1, 0, 0, 1, 1, 1, 0, 0, 0, 1}));
  const BatchResult result = batch->takeResult();
  EXPECT_EQ(result.valid, std::vector<std::uint8_t>(10, 1));
  EXPECT_EQ(result.colliding, std::vector<BodyPair>(10, kNoPair));
  EXPECT_EQ(result.device_states, 5U);
}

TEST_F(BatchParts, WithoutAnAnswerAreNeverFree)
{
  const auto batch = batchOf(100);
  batch->answered(batch->takeForCore(kAny));
  batch->answered({0, 32});
  batch->answered({0, 36});
  EXPECT_TRUE(batch->isComplete()) << "by its count, although states have no answer";
  batch->close();
  EXPECT_THROW(batch->takeResult(), std::logic_error);
}

TEST_F(BatchParts, ThatADeviceLeavesUndecidedGoToTheCores)
{
  const auto batch = batchOf(10);
  batch->join(1);
  batch->letCoresHelp(false);
  const StateRange part = batch->takeForDevice(1, kAny, 1.0);
  const StateRange mine = batch->beginAnswer(1, part);
  ASSERT_EQ(mine.count, 10U);
  batch->endAnswer(mine, {2, 3, 7});
  EXPECT_EQ(batch->answeredCount(), 7U);
  EXPECT_EQ(batch->result().undecided_states, 3U);
  std::size_t decided = 0;
  for (StateRange own = batch->takeForCore(kAny); own.count != 0; own = batch->takeForCore(kAny))
  {
    decided += own.count;
    batch->answered(own);
  }
  EXPECT_EQ(decided, 3U);
  EXPECT_TRUE(batch->isComplete());
}

TEST_F(BatchParts, OfALostDeviceGoBackAndItsLateAnswersDoNotCount)
{
  const auto batch = batchOf(1'000);
  batch->join(1);
  batch->letCoresHelp(false);
  const StateRange part = batch->takeForDevice(1, 600, 1.0);
  const StateRange half = batch->beginAnswer(1, {part.begin, 300});
  batch->endAnswer(half, {});
  EXPECT_EQ(batch->availableForCores(), 0U);
  batch->leave(1);
  EXPECT_EQ(batch->availableForCores(), 700U) << "300 are answered, and no device is left";
  EXPECT_EQ(batch->beginAnswer(1, {300, 300}).count, 0U);
  EXPECT_EQ(batch->takeForDevice(1, kAny, 1.0).count, 0U);
}

TEST_F(BatchParts, AreOvertakenFromTheirEndIfNoStateWaits)
{
  const auto batch = batchOf(100);
  batch->join(1);
  const StateRange part = batch->takeForDevice(1, kAny, 1.0);
  ASSERT_EQ(part.count, 100U);
  const StateRange overtaken = batch->takeForCore(kAny);
  EXPECT_EQ(overtaken.count, 32U);
  EXPECT_EQ(overtaken.end(), 100U);
  batch->answered(overtaken);
  const StateRange mine = batch->beginAnswer(1, part);
  EXPECT_EQ(mine.begin, 0U);
  EXPECT_EQ(mine.count, 68U);
  batch->endAnswer(mine, {});
  EXPECT_TRUE(batch->isComplete());
  EXPECT_EQ(batch->paceOf(1).states, 100U) << "all that the device did";
}

TEST_F(BatchParts, ThatWereOvertakenWhollyNeedNoEndOfTheirAnswer)
{
  const auto batch = batchOf(100);
  batch->join(1);
  const StateRange part = batch->takeForDevice(1, kAny, 1.0);
  for (StateRange own = batch->takeForCore(kAny); own.count != 0; own = batch->takeForCore(kAny))
    batch->answered(own);
  EXPECT_EQ(batch->beginAnswer(1, part).count, 0U);
  EXPECT_TRUE(batch->isComplete());
  batch->close();
}

TEST_F(BatchParts, OfAClosedBatchAreNeitherTakenNorAnswered)
{
  const auto batch = batchOf(1'000);
  batch->join(1);
  const StateRange part = batch->takeForDevice(1, 500, 1.0);
  batch->close();
  EXPECT_EQ(batch->beginAnswer(1, part).count, 0U);
  EXPECT_EQ(batch->takeForDevice(1, 500, 1.0).count, 0U);
  EXPECT_EQ(batch->takeForCore(kAny).count, 0U);
}

/// Threads take, answer, lose and overtake parts at random.
TEST_F(BatchParts, AreEachAnsweredOnce)
{
  for (std::uint64_t seed = kSeed; seed < kSeed + 20; ++seed)
  {
    std::vector<std::size_t> only_cores;
    std::mt19937_64 random(seed);
    for (std::size_t i = 0; i < 20'000; ++i)
      if (random() % 50 == 0)
        only_cores.push_back(i);
    const auto batch = batchOf(20'000, only_cores, 4);
    std::vector<std::atomic<int>> answers(20'000);
    for (std::size_t device = 0; device < 2; ++device)
      batch->join(device);
    const auto work_as_device = [&](std::size_t device)
    {
      std::mt19937_64 own(seed * 7 + device);
      for (StateRange part = batch->takeForDevice(device, 1 + own() % 3000, 0.3); part.count != 0;
           part = batch->takeForDevice(device, 1 + own() % 3000, 0.3))
      {
        if (own() % 3 == 0)
        {
          batch->giveBack(device);
          continue;
        }
        std::vector<std::size_t> undecided;
        const StateRange mine = batch->beginAnswer(device, part);
        for (std::size_t i = mine.begin; i < mine.end(); ++i)
          if (own() % 100 == 0)
            undecided.push_back(i);
          else if (batch->deviceRows().only_cores[i] == 0)
            ++answers[i];
        if (mine.count != 0)
          batch->endAnswer(mine, undecided);
      }
      batch->leave(device);
    };
    const auto work_as_core = [&]
    {
      while (!batch->isComplete())
      {
        const StateRange part = batch->takeForCore(kAny);
        for (std::size_t i = part.begin; i < part.end(); ++i)
          ++answers[i];
        if (part.count != 0)
          batch->answered(part);
        else
          batch->waitForCores(std::chrono::steady_clock::now() + std::chrono::milliseconds(1));
      }
    };
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < 2; ++i)
    {
      threads.emplace_back(work_as_device, i);
      threads.emplace_back(work_as_core);
    }
    for (std::thread& thread : threads)
      thread.join();
    for (std::size_t i = 0; i < answers.size(); ++i)
      ASSERT_EQ(answers[i], 1) << "state " << i << ", seed " << seed;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
