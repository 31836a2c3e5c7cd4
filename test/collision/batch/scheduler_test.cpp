// Cores and devices answer a batch together. A device that fails neither loses nor changes an answer.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "collision/batch/scheduler.h"
#include "collision/batch/scripted_device.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using Script = std::shared_ptr<DeviceScript>;

void lose()
{
  throw DeviceLost("gone");
}

void refuse()
{
  throw Error("no usable device");
}

class SchedulerTest : public testing::Test
{
 protected:
  Scheduler& scheduler()
  {
    if (!scheduler_)
    {
      std::vector<std::unique_ptr<DeviceWorker>> workers;
      for (const Script& script : devices_)
        workers.push_back(
            std::make_unique<DeviceWorker>([script] { return std::make_unique<ScriptedDevice>(script); }, limits_));
      scheduler_ = std::make_unique<Scheduler>(options_, std::move(workers), device_only_);
      if (opens_at_start_)
        scheduler_->openDevices(cartScene(1.0, 1), one_suffices_);
      else
        scheduler_->setScene(cartScene(1.0, 1));
    }
    return *scheduler_;
  }

  BatchResult check(std::size_t count)
  {
    const std::vector<double> states = cartStates(count);
    return scheduler().check({states.data(), count});
  }

  /// Checks a batch in the scene with the wall on `side`.
  BatchResult expectRight(std::size_t count, double side = 1.0, std::uint64_t revision = 1)
  {
    BatchResult result = check(count);
    EXPECT_EQ(result.valid, cartAnswers(cartStates(count), side));
    for (std::size_t i = 0; i < count; ++i)
      if ((result.colliding[i] == kNoPair) != (result.valid[i] == 1))
        ADD_FAILURE() << "the pair of state " << i;
    EXPECT_EQ(result.revision, revision);
    return result;
  }

  /// With an object at x = 3.5 m, which no state within the limits reaches.
  static std::shared_ptr<const PlanningScene> sceneWithAFarObject()
  {
    auto scene = std::make_shared<PlanningScene>(*cartScene(-1.0, 2));
    scene->objects.push_back({"far", Eigen::Isometry3d(Eigen::Translation3d(3.5, 0.0, 0.0)), {{Box{{0.5, 1, 1}}}}});
    return scene;
  }

  /// Waits until the device is destroyed, for at most 10 s.
  bool isGone() const
  {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (std::chrono::steady_clock::now() < deadline)
    {
      {
        const std::lock_guard<std::mutex> lock(device_->mutex);
        if (device_->alive == 0)
          return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }

  void restTime() const { std::this_thread::sleep_for(std::chrono::duration<double>(1.2 * limits_.retry_seconds)); }

  static constexpr std::size_t kCount = 30'000;
  // The cores take long enough for them that a device joins and the caller is asked; sanitized code is slower.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  static constexpr std::size_t kLong = 1'000'000;
#else
  static constexpr std::size_t kLong = 20'000'000;
#endif
  static constexpr std::size_t kMany = 300'000;  // the cores take longer for them than a thread to wake up
  const Script device_ = std::make_shared<DeviceScript>();
  std::vector<Script> devices_ = {device_};
  CheckerOptions options_;
  DeviceLimits limits_;
  bool device_only_ = true;
  bool opens_at_start_ = true;
  bool one_suffices_ = false;
  std::unique_ptr<Scheduler> scheduler_;
};

TEST_F(SchedulerTest, WithTheDeviceOnlyItAnswersAllStates)
{
  EXPECT_EQ(expectRight(1).device_states, 1U);
  EXPECT_EQ(expectRight(kCount).device_states, kCount);
  EXPECT_EQ(scheduler().deviceName(), "a device");
  EXPECT_EQ(check(0).valid.size(), 0U);
}

TEST_F(SchedulerTest, CoresAndDevicesShareALargeBatchButNoSmallOne)
{
  device_only_ = false;
  const auto second = std::make_shared<DeviceScript>();
  devices_.push_back(second);
  EXPECT_EQ(expectRight(1).device_states, 0U);
  EXPECT_EQ(expectRight(1000).device_states, 0U);
  std::size_t by_devices = 0;
  constexpr int kBatches = 50;  // a thread that starts late gets nothing
  for (int i = 0; i < kBatches && (device_->states == 0 || second->states == 0); ++i)
    by_devices += expectRight(kMany).device_states;
  EXPECT_GT(device_->states, 0U);
  EXPECT_GT(second->states, 0U);
  EXPECT_EQ(by_devices, device_->states + second->states);
}

/// They would take its cores away.
TEST_F(SchedulerTest, CoresDoNotCompeteWithASoftwareDevice)
{
  device_->is_software = true;
  device_only_ = false;
  for (const std::size_t count : {std::size_t(1), kCount})
    EXPECT_EQ(expectRight(count).device_states, count);
}

TEST_F(SchedulerTest, ADeviceThatIsBusyAtFirstJoinsLater)
{
  device_only_ = false;
  scheduler();
  const auto gate = std::make_shared<std::promise<void>>();
  device_->prepares = {[gate] { gate->get_future().wait(); }};
  scheduler().setScene(cartScene(-1.0, 2));
  const std::vector<double> states = cartStates(kLong);
  StateBatch batch{states.data(), states.size()};
  bool is_open = false;
  batch.go_on = [&](std::size_t /*answered*/)
  {
    if (!std::exchange(is_open, true))
      gate->set_value();
    return true;
  };
  const BatchResult result = scheduler().check(batch);
  EXPECT_EQ(result.valid, cartAnswers(states, -1.0));
  EXPECT_GT(result.device_states, 0U);
}

TEST_F(SchedulerTest, TheCoresDecideWhatADeviceLeavesUndecided)
{
  device_->undecided = {0, 1, 2, 500, 29'999};
  const BatchResult result = expectRight(kCount);
  EXPECT_EQ(result.undecided_states, 5U);
  EXPECT_EQ(result.device_states, kCount - 5);
}

TEST_F(SchedulerTest, StatesOutsideTheLimitsAreForTheCores)
{
  scheduler().setScene(sceneWithAFarObject());
  std::vector<double> states = cartStates(kCount);
  for (std::size_t i = 0; i < kCount; i += 1000)
    states[i] = 3.5;  // the device would find them free, because no state within the limits reaches the object
  const BatchResult result = scheduler().check({states.data(), kCount});
  for (std::size_t i = 0; i < kCount; ++i)
    ASSERT_EQ(result.valid[i], i % 1000 != 0 && states[i] > 0.0 ? 1 : 0) << i;
  EXPECT_EQ(result.device_states, kCount - kCount / 1000);
}

TEST_F(SchedulerTest, ALossInACheckReopensTheDeviceAndLosesNoState)
{
  expectRight(10);
  device_->parts = {nullptr, lose};
  EXPECT_EQ(expectRight(kCount).device_states, kCount);
  EXPECT_EQ(device_->opened, 2);
  EXPECT_EQ(device_->alive, 1);
  const DeviceHistory history = scheduler().history();
  EXPECT_EQ(history.losses, 1U);
  EXPECT_EQ(history.rebuilds, 1U);
  EXPECT_EQ(history.batches_on_cpu, 0U);
  EXPECT_EQ(history.last_error, "gone");
  EXPECT_FALSE(history.on_cpu);
}

TEST_F(SchedulerTest, ALossInASceneChangeKeepsTheNewScene)
{
  expectRight(10);
  device_->prepares = {lose};
  scheduler().setScene(cartScene(-1.0, 2));
  EXPECT_EQ(expectRight(kCount, -1.0, 2).device_states, kCount);
  EXPECT_EQ(device_->opened, 2);
  EXPECT_EQ(scheduler().history().losses, 1U);
}

TEST_F(SchedulerTest, AfterTwoLossesInACallTheCpuAnswersUntilTheRetry)
{
  limits_.retry_seconds = 1.5;  // longer than some batches take under the thread sanitizer
  scheduler();
  device_->parts = {lose, lose};
  EXPECT_EQ(expectRight(kCount).device_states, 0U);
  EXPECT_EQ(scheduler().deviceName(), "CPU");
  EXPECT_NE(scheduler().deviceWarning().find("the device has failed, so the CPU checks the states: gone"),
            std::string::npos);
  EXPECT_TRUE(scheduler().history().on_cpu);
  EXPECT_FALSE(scheduler().history().rebuild_failed) << "it could be reopened, and was lost again";
  EXPECT_EQ(device_->alive, 0);
  scheduler().setScene(cartScene(-1.0, 3));
  EXPECT_EQ(expectRight(kCount, -1.0, 3).device_states, 0U);
  EXPECT_EQ(scheduler().history().batches_on_cpu, 1U);
  restTime();
  EXPECT_EQ(expectRight(kCount, -1.0, 3).device_states, kCount);
  EXPECT_EQ(scheduler().deviceName(), "a device");
  EXPECT_EQ(scheduler().deviceWarning(), "");
}

TEST_F(SchedulerTest, ADeviceThatIsLostTooOftenIsNotReopened)
{
  for (int i = 0; i < 3; ++i)
  {
    scheduler();
    device_->parts = {lose};
    expectRight(kCount);
  }
  EXPECT_TRUE(scheduler().history().on_cpu);
  EXPECT_EQ(scheduler().history().losses, 3U);
  const int opened = device_->opened;
  EXPECT_EQ(expectRight(kCount).device_states, 0U);
  EXPECT_EQ(device_->opened, opened);
}

TEST_F(SchedulerTest, TheCpuReplacesADeviceThatCannotBeReopened)
{
  limits_.retry_seconds = 1.5;  // longer than some batches take under the thread sanitizer
  for (const auto fail : {+[] { refuse(); }, +[] { throw DeviceLost("no usable device"); }})
  {
    scheduler();
    device_->parts = {lose};
    device_->opens = {fail};
    expectRight(kCount);
    EXPECT_TRUE(scheduler().history().on_cpu);
    EXPECT_TRUE(scheduler().history().rebuild_failed);
    EXPECT_EQ(scheduler().history().last_error, "no usable device");
    restTime();
    EXPECT_EQ(expectRight(kCount).device_states, kCount);
    EXPECT_FALSE(scheduler().history().rebuild_failed);
    scheduler_.reset();
  }
}

TEST_F(SchedulerTest, FailureToOpenAtTheStartIsAnError)
{
  device_->opens = {refuse};
  EXPECT_EQ(errorOf([&] { scheduler(); }), "no usable device");
}

TEST_F(SchedulerTest, TheCpuAnswersUntilALaterDeviceOpens)
{
  opens_at_start_ = false;
  limits_.retry_seconds = 1.5;  // longer than some batches take under the thread sanitizer
  for (const auto& [fail, losses] : {std::pair{+[] { refuse(); }, 0U}, std::pair{+[] { lose(); }, 2U}})
  {
    device_->opens = {fail, losses != 0 ? fail : nullptr};
    EXPECT_EQ(expectRight(kCount).device_states, 0U);
    EXPECT_EQ(scheduler().deviceName(), "CPU");
    EXPECT_TRUE(scheduler().history().on_cpu);
    EXPECT_EQ(scheduler().history().losses, losses);
    restTime();
    EXPECT_EQ(expectRight(kCount).device_states, kCount);
    EXPECT_EQ(scheduler().history().rebuilds, 0U);
    scheduler_.reset();
  }
}

/// A static scene has no later change at which the device could be opened.
TEST_F(SchedulerTest, ABatchOpensADeviceAgainThatCouldNotBeOpened)
{
  device_only_ = false;
  opens_at_start_ = false;
  limits_.retry_seconds = 1.0;
  device_->opens = {refuse};
  expectRight(kCount);
  EXPECT_EQ(device_->opened, 0);
  restTime();
  for (int i = 0; i < 100 && scheduler().deviceName() == "CPU"; ++i)
  {
    expectRight(kCount);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_EQ(scheduler().deviceName(), "a device");
}

TEST_F(SchedulerTest, OneOfSeveralDevicesSufficesIfTheCallerSaysSo)
{
  const auto second = std::make_shared<DeviceScript>();
  second->name = "B";
  devices_.push_back(second);
  one_suffices_ = true;
  device_->opens = {refuse};
  EXPECT_EQ(expectRight(kCount).device_states, kCount);
  EXPECT_EQ(scheduler().deviceName(), "B");
  EXPECT_NE(scheduler().deviceWarning().find("no usable device"), std::string::npos) << scheduler().deviceWarning();
  scheduler_.reset();
  device_->opens = {refuse};
  second->opens = {refuse};
  EXPECT_EQ(errorOf([&] { scheduler(); }), "no usable device");
  scheduler_.reset();
  one_suffices_ = false;
  second->opens = {refuse};
  EXPECT_EQ(errorOf([&] { scheduler(); }), "no usable device");
}

TEST_F(SchedulerTest, ASceneThatTheDeviceCannotHoldIsTheCpus)
{
  scheduler();
  device_->prepares = {[] { throw Error("the scene does not fit"); }};
  scheduler().setScene(cartScene(-1.0, 2));
  EXPECT_EQ(expectRight(kCount, -1.0, 2).device_states, 0U);
  EXPECT_TRUE(scheduler().history().on_cpu);
  EXPECT_EQ(scheduler().history().last_error, "the scene does not fit");
  EXPECT_FALSE(scheduler().history().rebuild_failed) << "nothing is wrong with the device";
}

TEST_F(SchedulerTest, ADeviceThatHangsIsAbandonedForGood)
{
  limits_.device_seconds = 0.05;
  limits_.retry_seconds = 0.0;
  scheduler();
  const auto gate = std::make_shared<std::promise<void>>();
  device_->parts = {[gate] { gate->get_future().wait(); }};
  const int opened = device_->opened;
  EXPECT_EQ(expectRight(kCount).device_states, 0U);
  EXPECT_EQ(scheduler().history().losses, 1U);
  EXPECT_TRUE(scheduler().history().rebuild_failed);
  EXPECT_NE(scheduler().history().last_error.find("has not answered for 0.05"), std::string::npos);
  scheduler().setScene(cartScene(-1.0, 2));
  EXPECT_EQ(expectRight(kCount, -1.0, 2).device_states, 0U);
  EXPECT_EQ(scheduler().deviceName(), "CPU");
  EXPECT_EQ(device_->opened, opened);
  scheduler_.reset();
  EXPECT_EQ(device_->alive, 1) << "destroyed while its thread is in it";
  gate->set_value();  // it reads its part now, whose states are gone
  EXPECT_TRUE(isGone()) << "nobody destroyed the device of the thread that came back";
}

/// The cores overtake it, long before its limit.
TEST_F(SchedulerTest, ADeviceThatHangsDoesNotDelayAnAnswerOfTheCores)
{
  device_only_ = false;
  scheduler();
  const auto gate = std::make_shared<std::promise<void>>();
  const auto is_in = std::make_shared<std::atomic<bool>>(false);
  device_->parts = {[gate, is_in]
                    {
                      *is_in = true;
                      gate->get_future().wait();
                    }};
  for (int i = 0; i < 1000 && !*is_in; ++i)  // a thread that starts late gets nothing
    expectRight(kMany);
  ASSERT_TRUE(*is_in);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(expectRight(kMany).device_states, 0U);
  EXPECT_EQ(scheduler().history().losses, 0U) << "its limit has not passed";
  gate->set_value();
}

/// Its thread comes back from the driver when the device counts as hanging, and must not open it again.
TEST_F(SchedulerTest, ADeviceThatHangsWhenItIsDroppedIsNotOpenedAgain)
{
  limits_.device_seconds = 0.05;
  limits_.retry_seconds = 0.0;
  scheduler();
  const auto gate = std::make_shared<std::promise<void>>();
  device_->parts = {lose};
  device_->ends = {[gate] { gate->get_future().wait(); }};
  EXPECT_EQ(expectRight(kCount).device_states, 0U);
  EXPECT_EQ(scheduler().history().losses, 1U);
  gate->set_value();
  EXPECT_TRUE(isGone());
  scheduler_.reset();
  EXPECT_EQ(device_->opened, 1);
}

TEST_F(SchedulerTest, ADeviceThatHangsWhileItOpensIsAbandoned)
{
  limits_.device_seconds = 0.05;
  opens_at_start_ = false;
  const auto gate = std::make_shared<std::promise<void>>();
  device_->opens = {[gate] { gate->get_future().wait(); }};
  EXPECT_EQ(expectRight(kCount).device_states, 0U);
  gate->set_value();
  EXPECT_TRUE(scheduler().history().on_cpu);
  EXPECT_TRUE(scheduler().history().rebuild_failed);
}

TEST_F(SchedulerTest, ACheckThatWaitsForTheDeviceCanBeEnded)
{
  limits_.device_seconds = 10.0;
  scheduler();
  const auto gate = std::make_shared<std::promise<void>>();
  device_->prepares = {[gate] { gate->get_future().wait(); }};
  scheduler().setScene(cartScene(-1.0, 2));
  const std::vector<double> states = cartStates(10);
  StateBatch batch{states.data(), states.size()};
  batch.go_on = [](std::size_t /*answered*/) { return false; };
  EXPECT_THROW(scheduler().check(batch), Cancelled);
  gate->set_value();
  EXPECT_EQ(expectRight(10, -1.0, 2).device_states, 10U);
}

TEST_F(SchedulerTest, AnErrorOfTheDeviceInABatchLosesNoState)
{
  scheduler();
  device_->parts = {nullptr, [] { throw Error("the driver says no"); }};
  expectRight(kCount);
  EXPECT_TRUE(scheduler().history().on_cpu);
  EXPECT_EQ(scheduler().history().last_error, "the driver says no");
}

TEST_F(SchedulerTest, StatesThatNoDeviceCanPlaceAreForTheCores)
{
  scheduler().setScene(sceneWithAFarObject());
  const std::vector<double> outside(1000, 3.5);
  const BatchResult result = scheduler().check({outside.data(), outside.size()});
  EXPECT_EQ(result.valid, std::vector<std::uint8_t>(1000, 0));
  EXPECT_EQ(result.device_states, 0U);
  EXPECT_EQ(device_->states, 0U);
}

TEST_F(SchedulerTest, ADeviceThatHangsAtItsEndIsAbandoned)
{
  limits_.device_seconds = 0.05;
  scheduler();
  const auto gate = std::make_shared<std::promise<void>>();
  device_->ends = {[gate] { gate->get_future().wait(); }};
  scheduler_.reset();
  EXPECT_EQ(device_->alive, 1);
  gate->set_value();
  EXPECT_TRUE(isGone());
}

TEST_F(SchedulerTest, AnErrorOfTheCallerEndsTheCheck)
{
  for (const bool device_only : {true, false})
  {
    device_only_ = device_only;
    scheduler_.reset();
    scheduler();
    device_->parts.assign(100'000, [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); });
    const std::vector<double> states = cartStates(kLong);
    StateBatch batch{states.data(), states.size()};
    batch.go_on = [](std::size_t /*answered*/) -> bool { throw Error("interrupted"); };
    EXPECT_EQ(errorOf([&] { scheduler().check(batch); }), "interrupted");
    {
      const std::lock_guard<std::mutex> lock(device_->mutex);
      device_->parts.clear();
    }
    expectRight(kCount);
  }
}

TEST_F(SchedulerTest, ADeviceThatHangsInASceneChangeIsAbandoned)
{
  limits_.device_seconds = 0.05;
  scheduler();
  const auto gate = std::make_shared<std::promise<void>>();
  device_->prepares = {[gate] { gate->get_future().wait(); }};
  scheduler().setScene(cartScene(-1.0, 2));
  EXPECT_EQ(expectRight(kCount, -1.0, 2).device_states, 0U);
  EXPECT_TRUE(scheduler().history().on_cpu);
  gate->set_value();
}

TEST_F(SchedulerTest, ANewFaultOfADeviceIsToldAndCountsAsALoss)
{
  expectRight(10);
  EXPECT_EQ(scheduler().history().losses, 0U);
  {
    const std::lock_guard<std::mutex> lock(device_->mutex);
    device_->fault = "no doubles";
  }
  for (int i = 0; i < 2; ++i)
  {
    expectRight(10);
    EXPECT_EQ(scheduler().deviceWarning(), "no doubles");
    EXPECT_EQ(scheduler().history().losses, 1U);
  }
}

TEST_F(SchedulerTest, OneOfTwoDevicesWorksOnWhenTheOtherIsLost)
{
  const auto second = std::make_shared<DeviceScript>();
  second->name = "B";
  devices_.push_back(second);
  scheduler();
  device_->prepares = {lose, lose};
  expectRight(kCount);
  scheduler().setScene(cartScene(-1.0, 2));
  expectRight(kCount, -1.0, 2);
  EXPECT_EQ(scheduler().deviceName(), "B");
  EXPECT_NE(scheduler().deviceWarning().find("the device a device has failed and is not used: gone"), std::string::npos)
      << scheduler().deviceWarning();
  EXPECT_FALSE(scheduler().history().on_cpu);
}

TEST_F(SchedulerTest, WrongRequestsAreTheCallersAndLoseNoDevice)
{
  EXPECT_THROW(scheduler().check({nullptr, 0, "legs"}), Error);
  std::vector<double> states = cartStates(1000);
  states[999] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(errorOf([&] { scheduler().check({states.data(), 1000}); }).find("state 999:"), std::string::npos);
  EXPECT_EQ(scheduler().history().losses, 0U);
  EXPECT_EQ(device_->opened, 1);
  expectRight(kCount);
}

TEST_F(SchedulerTest, ASceneThatTheCpuRejectsIsRefused)
{
  scheduler();
  auto wrong = std::make_shared<PlanningScene>(*cartScene(-1.0, 2));
  wrong->objects[0].pose.translation().x() = std::nan("");
  EXPECT_THROW(scheduler().setScene(wrong), Error);
  EXPECT_EQ(expectRight(kCount).device_states, kCount);
}

TEST_F(SchedulerTest, PassesOnTheNeighbourhoodsOfStates)
{
  JointNeighbourhood around;
  std::vector<std::uint32_t> rows;
  std::vector<double> states;
  for (std::size_t i = 0; i < kCount; ++i)
  {
    rows.push_back(static_cast<std::uint32_t>(i % 2));
    states.push_back(i % 4 < 2 ? -0.5 : -0.2);
  }
  around.travel = {{0.1, 0.0}, {0.3, 0.0}};
  for (const std::size_t count : {std::size_t{1}, std::size_t{64}, std::size_t{65}, std::size_t{256}, kCount})
  {
    around.rows.assign(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(count));
    const BatchResult result = scheduler().check({states.data(), count, "", &around});
    for (std::size_t i = 0; i < count; ++i)
      ASSERT_EQ(result.valid[i], i % 4 == 3 ? 0 : 1) << i << " of " << count;  // -0.2 + 0.3 is in the wall
  }
}

TEST_F(SchedulerTest, TheCallerHearsOfTheProgressAndCanEndTheCheck)
{
  for (const bool device_only : {true, false})
  {
    device_only_ = device_only;
    scheduler_.reset();
    scheduler();
    const auto slow = [] { std::this_thread::sleep_for(std::chrono::milliseconds(30)); };
    device_->parts.assign(1000, slow);
    const std::vector<double> states = cartStates(kLong);
    const auto caller = std::this_thread::get_id();
    StateBatch batch{states.data(), states.size()};
    std::size_t calls = 0;
    batch.go_on = [&](std::size_t answered)
    {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      EXPECT_LE(answered, states.size());
      return ++calls < 3;
    };
    EXPECT_THROW(scheduler().check(batch), Cancelled);
    EXPECT_EQ(calls, 3U);
    {
      const std::lock_guard<std::mutex> lock(device_->mutex);
      device_->parts.clear();
    }
    expectRight(kCount);
  }
}

TEST_F(SchedulerTest, ADeviceIsDestroyedOnItsThread)
{
  scheduler();
  device_->parts = {lose};
  expectRight(kCount);
  scheduler_.reset();
  ASSERT_EQ(device_->destroyed_on.size(), 2U);
  EXPECT_EQ(device_->destroyed_on[0], device_->destroyed_on[1]);
  EXPECT_NE(device_->destroyed_on[0], std::this_thread::get_id());
}

/// Also while scenes change, and while devices are lost and come late.
TEST_F(SchedulerTest, ChecksOfSeveralThreadsRunSideBySide)
{
  for (const bool device_only : {false, true})
  {
    device_only_ = device_only;
    limits_.retry_seconds = 0.01;
    limits_.max_losses = 1000;
    if (devices_.size() == 1)
      devices_.push_back(std::make_shared<DeviceScript>());
    for (const Script& device : devices_)
      for (int i = 0; i < 200; ++i)
        device->parts.push_back(i % 7 == 3 ? lose
                                           : [] { std::this_thread::sleep_for(std::chrono::microseconds(100)); });
    scheduler_.reset();
    scheduler();
    std::vector<std::future<void>> callers;
    for (int caller = 0; caller < 4; ++caller)
      callers.push_back(std::async(std::launch::async,
                                   [this]
                                   {
                                     for (std::size_t count : {1U, 100U, 5'000U, 30'000U, 30'000U, 30'000U})
                                     {
                                       const std::vector<double> states = cartStates(count);
                                       const BatchResult result = scheduler_->check({states.data(), count});
                                       const double side = result.revision % 2 == 1 ? 1.0 : -1.0;
                                       EXPECT_EQ(result.valid, cartAnswers(states, side));
                                     }
                                   }));
    for (std::uint64_t revision = 2; revision < 6; ++revision)
      scheduler().setScene(cartScene(revision % 2 == 1 ? 1.0 : -1.0, revision));
    for (std::future<void>& caller : callers)
      caller.get();
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
