// The node's checkers when the device fails after the start. No ROS master is needed.

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include <gtest/gtest.h>

#include "collision/batch/device_parts.h"
#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "node/endpoints/diagnostics.h"
#include "scene/change_testing.h"
#include "scene/slider_robot.h"
#include "service/checker_maker.h"

namespace gpu_planning_scene::core
{
namespace
{
/// A device that finds all states free, and is lost in each of its next `losses` checks.
class Device : public BatchDevice
{
 public:
  explicit Device(std::shared_ptr<std::atomic<int>> losses) : losses_(std::move(losses)) {}
  void prepare(const DeviceTask&) override {}
  void check(DeviceParts& parts) override
  {
    for (StateRange part = parts.take(1000); part.count != 0; part = parts.take(1000))
    {
      if (*losses_ > 0)
      {
        --*losses_;
        throw DeviceLost("the GPU was reset");
      }
      if (const StateRange mine = parts.beginAnswer(part); mine.count != 0)
        parts.endAnswer(mine, {});
    }
  }
  std::string name() const override { return "a device"; }
  bool isSoftware() const override { return false; }
  std::string fault() const override { return {}; }

 private:
  std::shared_ptr<std::atomic<int>> losses_;
};

/// States of a request for the second queue, whose checker is made with its first request.
constexpr std::size_t kLarge = 2000;

class DeviceDiagnostics : public testing::Test
{
 protected:
  DeviceDiagnostics()
  {
    options_.device_only = true;
    options_.limits.device_seconds = 0.2;
  }
  ~DeviceDiagnostics() override { repaired_.set_value(); }

  /// Sets the fault of opening the device from now on: it throws, waits, or does nothing.
  void openWith(void (*fault)(const std::shared_future<void>& repaired)) { fault_ = fault; }

  CheckServer& server()
  {
    if (!server_)
    {
      // A thread that waits for `repaired` may go on after the end of the test, so it must not use `this` afterwards.
      const OpenDevice open =
          [this, losses = losses_, repaired = repaired_.get_future().share()](const BatchCheckerOptions&)
      {
        if (fault_ != nullptr)
          fault_.load()(repaired);
        return std::make_unique<Device>(losses);
      };
      const MakeChecker make = makeCheckers(options_, open, [](const std::string&) {});
      server_ = std::make_unique<CheckServer>(store_, diagnostics_.watched(make), CheckServerOptions());
    }
    return *server_;
  }

  CheckAnswer ask(std::size_t count)
  {
    CheckJob job;
    job.states.assign(2 * count, 0.0);
    return server().submit(std::move(job)).get();
  }

  int level() { return diagnostics_.status(store_, server()).level; }

  std::atomic<void (*)(const std::shared_future<void>&)> fault_{nullptr};
  std::promise<void> repaired_;
  std::shared_ptr<std::atomic<int>> losses_ = std::make_shared<std::atomic<int>>(0);
  BatchCheckerOptions options_;
  SceneStore store_{PlanningScene(sliderRobot()), {}, {}};
  Diagnostics diagnostics_;
  std::unique_ptr<CheckServer> server_;
};

TEST_F(DeviceDiagnostics, ANamedDeviceThatCannotBeOpenedAtTheStartIsAnError)
{
  options_.device = "software";
  openWith([](const auto&) { throw Error("no usable device"); });
  EXPECT_EQ(errorOf([&] { server(); }), "no usable device");
}

TEST_F(DeviceDiagnostics, WithoutAUsableDeviceAtTheStartTheCpuChecksAllStates)
{
  openWith([](const auto&) { throw Error("no usable device"); });
  for (const std::size_t count : {std::size_t{1}, kLarge})
  {
    const CheckAnswer answer = ask(count);
    EXPECT_EQ(answer.result.valid.size(), count);
    EXPECT_EQ(answer.device, "CPU");
  }
}

TEST_F(DeviceDiagnostics, TheCpuStandsInForADeviceThatCannotBeOpenedOnceMore)
{
  EXPECT_EQ(ask(1).result.valid.size(), 1u);
  openWith([](const auto&) { throw DeviceLost("the GPU was reset"); });
  const CheckAnswer answer = ask(kLarge);
  EXPECT_EQ(answer.result.valid.size(), kLarge);
  EXPECT_EQ(answer.device, "CPU");
}

TEST_F(DeviceDiagnostics, ADeviceThatHangsWhenItIsOpenedOnceMoreHoldsNobodyUp)
{
  EXPECT_EQ(ask(1).result.valid.size(), 1u);
  openWith([](const auto& repaired) { repaired.wait(); });
  EXPECT_EQ(ask(kLarge).result.valid.size(), kLarge);
  server().stop();
}

TEST_F(DeviceDiagnostics, DiagnosticsReportCpuFallbackAndMissingDevice)
{
  using diagnostic_msgs::DiagnosticStatus;
  options_.limits.retry_seconds = 0.1;
  options_.limits.max_losses = 100;
  const auto retry = [this]
  { std::this_thread::sleep_for(std::chrono::duration<double>(options_.limits.retry_seconds)); };
  ask(1);
  EXPECT_EQ(level(), DiagnosticStatus::OK);
  *losses_ = 1;
  EXPECT_EQ(ask(1).device, "a device") << "made anew";
  EXPECT_EQ(level(), DiagnosticStatus::OK);
  *losses_ = 2;
  ask(1);
  EXPECT_EQ(level(), DiagnosticStatus::WARN);
  retry();
  ask(1);
  EXPECT_EQ(level(), DiagnosticStatus::OK);
  *losses_ = 1;
  openWith([](const auto&) { throw Error("no usable device"); });
  ask(1);
  EXPECT_EQ(level(), DiagnosticStatus::ERROR);
  const std::string message = diagnostics_.status(store_, server()).message;
  EXPECT_NE(message.find("no usable device"), std::string::npos) << message;
  openWith(nullptr);
  retry();
  ask(1);
  EXPECT_EQ(level(), DiagnosticStatus::OK);
}

TEST_F(DeviceDiagnostics, DiagnosticsCountThePartsThatAreOnlySurfaces)
{
  const auto surface_parts = [this]
  {
    for (const auto& item : diagnostics_.status(store_, server()).values)
      if (item.key == "surface_parts")
        return item.value;
    return std::string();
  };
  ask(1);
  EXPECT_EQ("0", surface_parts());
  SceneChange open;
  open.is_diff = true;
  open.objects = {objectChange(Operation::Add, "sheet", {triangleAt()})};
  store_.apply(open, {});
  EXPECT_EQ("1", surface_parts());
}

TEST_F(DeviceDiagnostics, DiagnosticsAreShortWhateverIsInThem)
{
  ask(1);
  openWith([](const auto&) { throw Error("no device '" + std::string(100000, 'x') + "'"); });
  *losses_ = 1;
  ask(1);
  diagnostics_.refused("there is no group '" + std::string(100000, 'x') + "'");
  const diagnostic_msgs::DiagnosticStatus status = diagnostics_.status(store_, server());
  EXPECT_LT(ros::serialization::serializationLength(status), 10000u);
  EXPECT_NE(status.message.find("no device 'xxx"), std::string::npos) << status.message;
}
}  // namespace
}  // namespace gpu_planning_scene::core
