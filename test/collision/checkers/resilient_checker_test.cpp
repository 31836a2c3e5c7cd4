// A device that fails neither loses nor changes an answer.

#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "collision/checkers/resilient_checker.h"
#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
using Scene = std::shared_ptr<const PlanningScene>;

/// Controls and records the fake checkers.
struct Script
{
  using Step = std::function<void()>;  // throws, or waits, or does nothing
  /// First step of each of the next calls of the constructor, setScene() and check(). Calls without a step just run.
  std::deque<Step> makes, scenes, checks;
  std::function<bool(const PlanningScene&)> takes = [](const PlanningScene&) { return true; };

  std::mutex mutex;
  std::string warning = "coarse";
  int made = 0;
  int alive = 0;
  std::vector<std::size_t> batches;  // sizes of the checked batches
  std::vector<std::thread::id> destroyed_on;

  void next(std::deque<Step>& steps)
  {
    Step step;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (steps.empty())
        return;
      step = steps.front();
      steps.pop_front();
    }
    if (step)
      step();
  }
};

/// A state is free if its first variable is above 0, or above the travel of the first joint around it. A checker whose
/// scene is half built must not be used.
class FakeChecker : public StateChecker
{
 public:
  FakeChecker(std::shared_ptr<Script> script, const char* name, Scene scene) : script_(std::move(script)), name_(name)
  {
    script_->next(script_->makes);
    take(std::move(scene));
    const std::lock_guard<std::mutex> lock(script_->mutex);
    ++script_->made;
    ++script_->alive;
  }
  ~FakeChecker() override
  {
    const std::lock_guard<std::mutex> lock(script_->mutex);
    --script_->alive;
    script_->destroyed_on.push_back(std::this_thread::get_id());
  }

  void setScene(Scene scene) override
  {
    scene_.reset();  // half built
    script_->next(script_->scenes);
    take(std::move(scene));
  }

  BatchResult check(const double* states, std::size_t count, const std::string& group,
                    const JointNeighbourhood* around) override
  {
    if (!scene_)
      throw std::logic_error("asked with half a scene");
    script_->next(script_->checks);
    if (!group.empty())
      throw Error("there is no group '" + group + "'");
    const std::size_t width = scene_->robot->variables().size();
    const std::size_t joints = scene_->robot->joints().size();
    BatchResult result;
    for (std::size_t i = 0; i < count; ++i)
    {
      const double travel = around ? around->travel[around->rows[i] * joints].angle : 0.0;
      result.valid.push_back(states[i * width] > travel ? 1 : 0);
      result.colliding.push_back(result.valid.back() ? BodyPair{-1, -1} : BodyPair{0, 1});
    }
    result.revision = scene_->revision;
    const std::lock_guard<std::mutex> lock(script_->mutex);
    script_->batches.push_back(count);
    return result;
  }

  SceneReport report(const std::string&) override
  {
    SceneReport report;
    report.trees = scene_->revision;
    return report;
  }
  std::string deviceName() const override { return name_; }
  std::string deviceWarning() const override
  {
    const std::lock_guard<std::mutex> lock(script_->mutex);
    return std::string(name_) == "CPU" ? "" : script_->warning;
  }

 private:
  void take(Scene scene)
  {
    if (!script_->takes(*scene))
      throw Error("revision " + std::to_string(scene->revision) + " does not fit");
    scene_ = std::move(scene);
  }

  std::shared_ptr<Script> script_;
  const char* name_;
  Scene scene_;
};

void lost()
{
  throw DeviceLost("gone");
}

class Resilient : public testing::Test
{
 protected:
  static Scene scene(std::uint64_t revision)
  {
    static const auto robot = robotOf(armUrdf());
    PlanningScene made(robot);
    made.revision = revision;
    return std::make_shared<const PlanningScene>(made);
  }

  ResilientChecker& checker()
  {
    if (!checker_)
    {
      const auto maker = [](const std::shared_ptr<Script>& script, const char* name) {
        return [script, name](const Scene& made_for) { return std::make_unique<FakeChecker>(script, name, made_for); };
      };
      checker_ = std::make_unique<ResilientChecker>(scene(1), maker(device_, "a device"), maker(cpu_, "CPU"), options_,
                                                    opening_);
    }
    return *checker_;
  }

  /// Checks two states, of which the first is free, and returns the revision of the answer.
  std::uint64_t ask()
  {
    std::vector<double> states(2 * scene(0)->robot->variables().size(), 0.0);
    states[0] = 1.0;
    const BatchResult result = checker().check(states.data(), 2);
    EXPECT_EQ(result.valid, (std::vector<std::uint8_t>{1, 0}));
    EXPECT_EQ(result.colliding.at(1)[1], 1);
    return result.revision;
  }

  std::shared_ptr<Script> device_ = std::make_shared<Script>();
  std::shared_ptr<Script> cpu_ = std::make_shared<Script>();
  ResilientOptions options_;
  ResilientChecker::Opening opening_ = ResilientChecker::Opening::AtStart;
  std::unique_ptr<ResilientChecker> checker_;
};

TEST_F(Resilient, ALossInACheckRebuildsTheDeviceAndRepeatsTheCheck)
{
  EXPECT_EQ(ask(), 1u);
  checker().setScene(scene(2));
  device_->checks = {lost};
  EXPECT_EQ(ask(), 2u);
  EXPECT_EQ(device_->made, 2);
  EXPECT_EQ(device_->alive, 1);
  EXPECT_EQ(cpu_->made, 0);
  const DeviceHistory history = checker().history();
  EXPECT_EQ(history.losses, 1u);
  EXPECT_EQ(history.rebuilds, 1u);
  EXPECT_EQ(history.batches_on_cpu, 0u);
  EXPECT_EQ(history.last_error, "gone");
  EXPECT_FALSE(history.on_cpu);
}

TEST_F(Resilient, ANewWarningOfADeviceIsToldAndCountsAsALoss)
{
  EXPECT_EQ(ask(), 1u);
  EXPECT_EQ(checker().history().losses, 0u);
  device_->warning = "the device B was lost";
  for (int i = 0; i < 2; ++i)
  {
    EXPECT_EQ(ask(), 1u);
    EXPECT_EQ(checker().deviceWarning(), "the device B was lost");
    EXPECT_EQ(checker().history().losses, 1u);
    EXPECT_EQ(checker().history().last_error, "the device B was lost");
  }
}

TEST_F(Resilient, ALossInASceneChangeKeepsTheNewScene)
{
  EXPECT_EQ(ask(), 1u);
  device_->scenes = {lost};
  checker().setScene(scene(2));
  EXPECT_EQ(device_->made, 2);
  EXPECT_EQ(ask(), 2u);
  EXPECT_EQ(checker().report().trees, 2u);
  EXPECT_EQ(checker().history().losses, 1u);
}

TEST_F(Resilient, AfterTwoLossesTheCpuAnswersUntilTheRetry)
{
  options_.retry_seconds = 0.2;
  checker().setScene(scene(2));
  device_->checks = {lost, lost};
  EXPECT_EQ(ask(), 2u);
  EXPECT_EQ(checker().deviceName(), "CPU");
  EXPECT_EQ(checker().deviceWarning(), "");
  EXPECT_TRUE(checker().history().on_cpu);
  EXPECT_FALSE(checker().history().rebuild_failed) << "it could be made anew, and was lost again";
  EXPECT_EQ(checker().history().batches_on_cpu, 1u);
  checker().setScene(scene(3));
  EXPECT_EQ(ask(), 3u);
  EXPECT_EQ(cpu_->made, 1);
  EXPECT_EQ(device_->alive, 0);
  std::this_thread::sleep_for(std::chrono::duration<double>(1.2 * options_.retry_seconds));
  EXPECT_EQ(ask(), 3u);
  EXPECT_EQ(checker().deviceName(), "a device");
  EXPECT_EQ(checker().deviceWarning(), "coarse");
  EXPECT_EQ(checker().history().losses, 2u);
  EXPECT_EQ(checker().history().batches_on_cpu, 2u);
  EXPECT_EQ(cpu_->alive, 0) << "kept the CPU's trees of an old scene";
}

TEST_F(Resilient, ADeviceThatIsLostTooOftenIsNotRebuilt)
{
  for (int i = 0; i < 3; ++i)
  {
    checker();
    device_->checks = {lost};
    EXPECT_EQ(ask(), 1u);
  }
  EXPECT_TRUE(checker().history().on_cpu);
  EXPECT_EQ(checker().history().losses, 3u);
  const int made = device_->made;
  EXPECT_EQ(ask(), 1u);
  EXPECT_EQ(device_->made, made);
}

TEST_F(Resilient, TheCpuReplacesADeviceThatCannotBeRebuilt)
{
  options_.retry_seconds = 0.2;
  for (const auto fail : {+[] { throw Error("no usable device"); }, +[] { throw DeviceLost("no usable device"); }})
  {
    checker();
    device_->checks = {lost};
    device_->makes = {fail};
    EXPECT_EQ(ask(), 1u);
    EXPECT_TRUE(checker().history().on_cpu);
    EXPECT_TRUE(checker().history().rebuild_failed);
    EXPECT_EQ(checker().history().last_error, "no usable device");
    std::this_thread::sleep_for(std::chrono::duration<double>(1.2 * options_.retry_seconds));
    EXPECT_EQ(ask(), 1u);
    EXPECT_FALSE(checker().history().rebuild_failed);
    checker_.reset();
  }
}

TEST_F(Resilient, FailureToOpenAtTheStartIsAnError)
{
  device_->makes = {[] { throw Error("no usable device"); }};
  EXPECT_THROW(checker(), Error);
  EXPECT_EQ(cpu_->made, 0);
}

TEST_F(Resilient, OpenedLaterItIsTheDevices)
{
  opening_ = ResilientChecker::Opening::Later;
  EXPECT_EQ(ask(), 1u);
  EXPECT_EQ(checker().deviceName(), "a device");
  EXPECT_EQ(device_->made, 1);
  EXPECT_EQ(checker().history().rebuilds, 0u);
}

TEST_F(Resilient, TheCpuAnswersUntilALaterDeviceOpens)
{
  opening_ = ResilientChecker::Opening::Later;
  options_.retry_seconds = 0.2;
  for (const auto& [fail, losses] : {std::pair{+[] { throw Error("no usable device"); }, 0u}, std::pair{&lost, 2u}})
  {
    device_->makes = {fail, losses != 0 ? fail : nullptr};
    EXPECT_EQ(ask(), 1u);
    EXPECT_EQ(checker().deviceName(), "CPU");
    EXPECT_TRUE(checker().history().on_cpu);
    EXPECT_NE(checker().history().last_error, "");
    EXPECT_EQ(checker().history().losses, losses);
    std::this_thread::sleep_for(std::chrono::duration<double>(1.2 * options_.retry_seconds));
    EXPECT_EQ(ask(), 1u);
    EXPECT_EQ(checker().deviceName(), "a device");
    checker_.reset();
  }
}

TEST_F(Resilient, ADeviceThatHangsWhileItOpensLaterIsAbandoned)
{
  opening_ = ResilientChecker::Opening::Later;
  options_.device_seconds = 0.05;
  const auto gate = std::make_shared<std::promise<void>>();
  device_->makes = {[gate] { gate->get_future().wait(); }};
  EXPECT_EQ(ask(), 1u);
  EXPECT_TRUE(checker().history().on_cpu);
  EXPECT_EQ(checker().history().losses, 1u);
  gate->set_value();
}

TEST_F(Resilient, ASceneThatBothCheckersRejectIsRefusedAlsoIfOpenedLater)
{
  opening_ = ResilientChecker::Opening::Later;
  device_->takes = cpu_->takes = [](const PlanningScene&) { return false; };
  EXPECT_EQ(errorOf([&] { checker(); }), "revision 1 does not fit");
}

TEST_F(Resilient, ADeviceThatHangsIsAbandonedForGood)
{
  options_.device_seconds = 0.05;
  options_.retry_seconds = 0.0;
  checker();
  std::promise<void> gate;
  std::promise<void> passed;
  device_->checks = {[&]
                     {
                       gate.get_future().wait();
                       passed.set_value();
                     }};
  EXPECT_EQ(ask(), 1u);
  EXPECT_EQ(checker().history().losses, 1u);
  EXPECT_TRUE(checker().history().rebuild_failed);
  EXPECT_NE(checker().history().last_error.find("has not answered for 0.05"), std::string::npos);
  checker().setScene(scene(2));
  EXPECT_EQ(ask(), 2u);
  EXPECT_EQ(checker().deviceName(), "CPU");
  EXPECT_EQ(device_->made, 1);
  checker_.reset();
  EXPECT_EQ(device_->alive, 1) << "destroyed while the device is in it";
  gate.set_value();
  passed.get_future().wait();
  for (int i = 0; i < 1000; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(2)))
  {
    const std::lock_guard<std::mutex> lock(device_->mutex);
    if (device_->alive == 0)
      return;
  }
  FAIL() << "nobody destroyed the checker of the thread that came back";
}

TEST_F(Resilient, ADeviceThatHangsInASceneChangeIsAbandoned)
{
  options_.device_seconds = 0.05;
  checker();
  const auto gate = std::make_shared<std::promise<void>>();
  device_->scenes = {[gate] { gate->get_future().wait(); }};
  checker().setScene(scene(2));
  EXPECT_EQ(ask(), 2u);
  EXPECT_TRUE(checker().history().on_cpu);
  gate->set_value();
}

TEST_F(Resilient, AWrongRequestIsTheCallersAndLosesNoDevice)
{
  EXPECT_EQ(errorOf([&] { checker().check(nullptr, 0, "legs"); }), "there is no group 'legs'");
  EXPECT_EQ(checker().history().losses, 0u);
  EXPECT_EQ(device_->made, 1);
}

TEST_F(Resilient, ASceneThatBothCheckersRejectIsRefused)
{
  checker();
  device_->takes = cpu_->takes = [](const PlanningScene& scene) { return scene.revision != 2; };
  EXPECT_EQ(errorOf([&] { checker().setScene(scene(2)); }), "revision 2 does not fit");
  EXPECT_EQ(ask(), 1u);
  EXPECT_EQ(checker().deviceName(), "a device");
  EXPECT_EQ(checker().history().losses, 0u);
}

TEST_F(Resilient, ASceneThatTheDeviceCannotHoldIsTheCpus)
{
  checker();
  device_->takes = [](const PlanningScene& scene) { return scene.revision != 2; };
  checker().setScene(scene(2));
  EXPECT_EQ(ask(), 2u);
  EXPECT_TRUE(checker().history().on_cpu);
  EXPECT_EQ(checker().history().last_error, "revision 2 does not fit");
  EXPECT_FALSE(checker().history().rebuild_failed) << "nothing is wrong with the device";
}

TEST_F(Resilient, TheCpuAnswersACallForWhichTheDeviceIsLostTwice)
{
  const std::size_t width = scene(1)->robot->variables().size();
  constexpr std::size_t kCount = 1000;
  std::vector<double> states(kCount * width, 0.0);
  std::vector<std::uint8_t> expected;
  for (std::size_t i = 0; i < kCount; ++i)
  {
    states[i * width] = i % 3 == 0 ? 1.0 : -1.0;
    expected.push_back(i % 3 == 0 ? 1 : 0);
  }
  checker();
  device_->checks = {lost, lost};
  EXPECT_EQ(checker().check(states.data(), kCount).valid, expected);
  EXPECT_EQ(cpu_->batches, (std::vector<std::size_t>{kCount}));
  states[(kCount - 1) * width] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(errorOf([&] { checker().check(states.data(), kCount); }).find("state 999:"), std::string::npos);
}

TEST_F(Resilient, PassesOnTheNeighbourhoodsOfStates)
{
  const RobotModel& robot = *scene(1)->robot;
  const std::size_t width = robot.variables().size();
  constexpr std::size_t kRows = 7;
  constexpr std::size_t kCount = 1000;
  JointNeighbourhood around;
  around.travel.resize(kRows * robot.joints().size());
  for (std::size_t row = 0; row < kRows; ++row)
    around.travel[row * robot.joints().size()].angle = static_cast<double>(row);
  std::vector<double> states(kCount * width, 0.0);
  std::vector<std::uint8_t> expected;
  for (std::size_t i = 0; i < kCount; ++i)
  {
    around.rows.push_back(static_cast<std::uint32_t>(i % kRows));
    states[i * width] = static_cast<double>(i % 5) + 0.5;
    expected.push_back(states[i * width] > around.rows[i] ? 1 : 0);
  }
  EXPECT_EQ(checker().check(states.data(), kCount, "", &around).valid, expected);
}

TEST_F(Resilient, ADevicesCheckerIsDestroyedOnTheDevicesThread)
{
  checker();
  device_->checks = {lost};
  ask();
  checker_.reset();
  ASSERT_EQ(device_->destroyed_on.size(), 2u);
  EXPECT_EQ(device_->destroyed_on[0], device_->destroyed_on[1]);
  EXPECT_NE(device_->destroyed_on[0], std::this_thread::get_id());
}
}  // namespace
}  // namespace gpu_planning_scene::core
