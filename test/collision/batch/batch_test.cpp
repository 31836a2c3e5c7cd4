// Each state of a batch is answered once, whoever takes it and whatever happens to the devices.

#include <algorithm>
#include <chrono>
#include <future>
#include <numeric>
#include <random>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "collision/batch/batch.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kAny = 1'000'000;
constexpr std::size_t kMostStates = 100'000;  // of a batch

/// The states of a core's part.
std::vector<std::size_t> rowsOf(const std::vector<StateRange>& part)
{
  std::vector<std::size_t> rows;
  for (const StateRange& range : part)
    for (std::size_t i = range.begin; i < range.end(); ++i)
      rows.push_back(i);
  return rows;
}

std::vector<StateRange> takenBy(Batch& batch, std::size_t most = kAny)
{
  std::vector<StateRange> part;
  batch.takeForCore(most, part);
  return part;
}

class BatchParts : public testing::Test
{
 protected:
  static std::shared_ptr<Batch> batchOf(std::size_t count, const std::vector<std::size_t>& only_cores = {},
                                        std::size_t cores = 2)
  {
    auto batch = std::make_shared<Batch>(count, std::nullopt, cores);
    static const std::vector<double> states = []
    {
      std::vector<double> numbered(kMostStates);
      std::iota(numbered.begin(), numbered.end(), 1.0);
      return numbered;
    }();
    const auto suits_devices = [only_cores](std::size_t row)
    { return !std::binary_search(only_cores.begin(), only_cores.end(), row); };
    batch->setDeviceRows(std::make_unique<const DeviceRows>(states.data(), count, 1, suits_devices));
    return batch;
  }
};

TEST_F(BatchParts, OfCoresAreSmallAndBecomeSmaller)
{
  const auto batch = batchOf(10'000);
  std::size_t last = kAny;
  std::size_t next = 0;
  for (std::vector<StateRange> part = takenBy(*batch); !part.empty(); part = takenBy(*batch))
  {
    const std::vector<std::size_t> rows = rowsOf(part);
    EXPECT_EQ(rows.front(), next);
    EXPECT_LE(rows.size(), last);
    EXPECT_LE(rows.size(), 1'250U) << "an eighth, as there are two cores";
    last = rows.size();
    next = rows.back() + 1;
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
  EXPECT_EQ(rowsOf(takenBy(*batchOf(10'000), 8)).size(), 8U);
}

TEST_F(BatchParts, ThatOnlyCoresCanCheckHaveNoAnswerOfADevice)
{
  const auto batch = batchOf(10, {0, 3, 4, 9});
  batch->join(1);
  batch->letCoresHelp(false);
  const StateRange part = batch->takeForDevice(1, kAny, 1.0);
  std::vector<double> copied(10);
  batch->copyForDevice(part, copied.data());
  EXPECT_EQ(copied, (std::vector<double>{0, 2, 3, 3, 3, 6, 7, 8, 9, 9})) << "others in their places";
  const StateRange mine = batch->beginAnswer(1, part);
  ASSERT_EQ(mine.count, 10U);
  batch->result().valid[3] = 0;
  batch->result().colliding[3] = {1, 2};
  batch->endAnswer(mine, {4, 5});
  EXPECT_EQ(batch->answeredCount(), 5U);
  std::vector<int> by_cores(10, 0);
  const std::vector<StateRange> own = takenBy(*batch);
  for (const std::size_t row : rowsOf(own))
    ++by_cores[row];
  batch->answered(own);
  EXPECT_EQ(by_cores, (std::vector<int>{1, 0, 0, 1, 1, 1, 0, 0, 0, 1}));
  const BatchResult result = batch->takeResult();
  EXPECT_EQ(result.valid, std::vector<std::uint8_t>(10, 1));
  EXPECT_EQ(result.colliding, std::vector<BodyPair>(10, kNoPair));
  EXPECT_EQ(result.device_states, 5U);
}

TEST_F(BatchParts, WithoutAnAnswerAreNeverFree)
{
  const auto batch = batchOf(100);
  batch->answered(takenBy(*batch));
  batch->answered({{0, 32}});
  batch->answered({{0, 36}});
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
  const std::vector<StateRange> own = takenBy(*batch);
  EXPECT_EQ(rowsOf(own), (std::vector<std::size_t>{7, 2, 3})) << "one part, although they are scattered";
  batch->answered(own);
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
  const std::vector<StateRange> overtaken = takenBy(*batch);
  EXPECT_EQ(rowsOf(overtaken).size(), 32U);
  EXPECT_EQ(rowsOf(overtaken).back(), 99U);
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
  for (std::vector<StateRange> own = takenBy(*batch); !own.empty(); own = takenBy(*batch))
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
  EXPECT_TRUE(takenBy(*batch).empty());
}

TEST_F(BatchParts, ThatAreOvertakenWhileTheyAreBroughtInPiecesKeepTheirFirstStates)
{
  const auto batch = batchOf(100);
  batch->join(1);
  ASSERT_EQ(batch->takeForDevice(1, kAny, 1.0).count, 100U);
  const StateRange first = batch->beginAnswer(1, {0, 50});
  EXPECT_EQ(first.count, 50U);
  batch->endAnswer(first, {});
  batch->answered(takenBy(*batch));  // 68 to 99
  const StateRange second = batch->beginAnswer(1, {50, 25});
  EXPECT_EQ(second.begin, 50U);
  EXPECT_EQ(second.count, 18U) << "up to the overtaken ones";
  batch->endAnswer(second, {});
  EXPECT_EQ(batch->beginAnswer(1, {75, 25}).count, 0U);
  EXPECT_TRUE(batch->isComplete());
}

TEST_F(BatchParts, OfADeviceThatJoinsAgainAreNew)
{
  const auto batch = batchOf(1'000);
  batch->join(1);
  const StateRange part = batch->takeForDevice(1, 600, 1.0);
  batch->leave(1);
  EXPECT_FALSE(batch->hasJoined(1));
  batch->join(1);
  EXPECT_EQ(batch->beginAnswer(1, part).count, 0U) << "it went back";
  const StateRange again = batch->takeForDevice(1, kAny, 1.0);
  EXPECT_EQ(batch->beginAnswer(1, again).count, again.count);
  batch->endAnswer(again, {});
  EXPECT_EQ(batch->answeredCount(), again.count);
}

TEST_F(BatchParts, AreWaitedForByCloseWhileADeviceWrites)
{
  const auto batch = batchOf(100);
  batch->join(1);
  const StateRange mine = batch->beginAnswer(1, batch->takeForDevice(1, kAny, 1.0));
  batch->fail(std::make_exception_ptr(std::runtime_error("first")));
  auto closing = std::async(std::launch::async, [&] { batch->close(); });
  EXPECT_EQ(closing.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout);
  batch->endAnswer(mine, {});
  closing.get();
  batch->fail(std::make_exception_ptr(std::logic_error("second")));
  EXPECT_THROW(batch->takeResult(), std::runtime_error);
}

TEST_F(BatchParts, AreWaitedForByCloseWhileADeviceReads)
{
  const auto batch = std::make_shared<Batch>(1, std::nullopt, 1);
  std::promise<void> is_reading;
  std::promise<void> gate;
  const double state = 7.0;
  batch->setDeviceRows(std::make_unique<const DeviceRows>(&state, 1, 1,
                                                          [&](std::size_t /*row*/)
                                                          {
                                                            is_reading.set_value();
                                                            gate.get_future().wait();
                                                            return true;
                                                          }));
  double copied = 0.0;
  auto reading = std::async(std::launch::async, [&] { batch->copyForDevice({0, 1}, &copied); });
  is_reading.get_future().wait();
  auto closing = std::async(std::launch::async, [&] { batch->close(); });
  EXPECT_EQ(closing.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout);
  gate.set_value();
  closing.get();
  reading.get();
  EXPECT_EQ(copied, state);
}

TEST_F(BatchParts, AreZerosForADeviceAfterTheEndOfTheBatch)
{
  const auto batch = batchOf(10);
  batch->join(1);
  const StateRange part = batch->takeForDevice(1, kAny, 1.0);
  batch->close();
  std::vector<double> copied(part.count, -1.0);
  batch->copyForDevice(part, copied.data());
  EXPECT_EQ(copied, std::vector<double>(part.count, 0.0)) << "the states may be gone";
}

TEST_F(BatchParts, WhoseAnswersFailEndTheBatch)
{
  const auto batch = batchOf(100);
  batch->join(1);
  batch->beginAnswer(1, batch->takeForDevice(1, kAny, 1.0));
  batch->failAnswer(std::make_exception_ptr(std::runtime_error("no memory")));
  batch->close();
  EXPECT_THROW(batch->takeResult(), std::runtime_error);
}

/// Threads take, answer, lose and overtake parts at random. Every third state collides.
TEST_F(BatchParts, AreEachAnsweredOnceAndAsTheyShould)
{
  for (std::uint64_t seed = kSeed; seed < kSeed + 20; ++seed)
  {
    constexpr std::size_t kRows = 20'000;
    std::vector<std::size_t> only_cores;
    std::mt19937_64 random(seed);
    for (std::size_t i = 0; i < kRows; ++i)
      if (random() % 50 == 0)
        only_cores.push_back(i);
    const auto batch = batchOf(kRows, only_cores, 4);
    const auto write = [&](std::size_t row, bool hits)
    {
      if (!hits)
        return;
      batch->result().valid[row] = 0;
      batch->result().colliding[row] = {0, 1};
    };
    for (std::size_t device = 0; device < 2; ++device)
      batch->join(device);
    const auto work_as_device = [&](std::size_t device)
    {
      std::mt19937_64 own(seed * 7 + device);
      for (StateRange part = batch->takeForDevice(device, 1 + own() % 3000, 0.3); part.count != 0;
           part = batch->takeForDevice(device, 1 + own() % 3000, 0.3))
      {
        std::vector<double> copied(part.count);
        batch->copyForDevice(part, copied.data());
        if (own() % 3 == 0)
        {
          batch->giveBack(device);
          continue;
        }
        std::vector<std::size_t> undecided;
        const StateRange mine = batch->beginAnswer(device, part);
        for (std::size_t i = mine.begin; i < mine.end(); ++i)
        {
          const bool is_undecided = own() % 100 == 0;
          if (is_undecided)
            undecided.push_back(i);
          const bool may_be_wrong = is_undecided || std::binary_search(only_cores.begin(), only_cores.end(), i);
          write(i, may_be_wrong ? own() % 2 == 0 : i % 3 == 0);
        }
        if (mine.count != 0)
          batch->endAnswer(mine, undecided);
      }
      batch->leave(device);
    };
    const auto work_as_core = [&]
    {
      while (!batch->isComplete())
      {
        const std::vector<StateRange> part = takenBy(*batch);
        for (const std::size_t row : rowsOf(part))
          write(row, row % 3 == 0);
        if (!part.empty())
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
    batch->close();
    const BatchResult result = batch->takeResult();  // throws if a state has no answer, or if one has two
    for (std::size_t i = 0; i < kRows; ++i)
    {
      ASSERT_EQ(result.valid[i], i % 3 == 0 ? 0 : 1) << "state " << i << ", seed " << seed;
      ASSERT_EQ(result.colliding[i], i % 3 == 0 ? (BodyPair{0, 1}) : kNoPair) << "state " << i << ", seed " << seed;
    }
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
