// The node's checkers where the device fails after the start; no master is needed.

#include <atomic>
#include <future>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "node/checker_maker.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene
{
namespace
{
class CheckerMaker : public testing::Test
{
 protected:
  CheckerMaker() { resilience_.device_seconds = 0.2; }
  ~CheckerMaker() override { repaired_.set_value(); }

  /// What opens the device from now on; it throws, or waits, or does nothing.
  void openWith(void (*fault)(const std::shared_future<void>& repaired)) { fault_ = fault; }

  CheckServer& server()
  {
    if (!server_)
    {
      const OpenDevice open = [this, repaired = repaired_.get_future().share()](
                                  std::shared_ptr<const PlanningScene> scene, const BatchCheckerOptions&)
      {
        if (fault_ != nullptr)
          fault_.load()(repaired);
        return std::make_unique<CpuChecker>(std::move(scene));
      };
      server_ = std::make_unique<CheckServer>(store_, checkerMaker({}, resilience_, open, diagnostics_),
                                              CheckServerOptions());
    }
    return *server_;
  }

  CheckAnswer ask(std::size_t count)
  {
    CheckJob job;
    job.states.assign(2 * count, 0.0);
    return server().submit(std::move(job)).get();
  }

  std::atomic<void (*)(const std::shared_future<void>&)> fault_{nullptr};
  std::promise<void> repaired_;
  ResilientOptions resilience_;
  SceneStore store_{PlanningScene(sliderRobot()), {}, {}};
  Diagnostics diagnostics_;
  std::unique_ptr<CheckServer> server_;
};

constexpr std::size_t kLarge = 2000;  // states: of the lane whose checker is made with the first of them

TEST_F(CheckerMaker, aDeviceThatCannotBeOpenedAtTheStartIsAnError)
{
  openWith([](const auto&) { throw Error("no usable device"); });
  EXPECT_EQ(errorOf([&] { server(); }), "no usable device");
}

TEST_F(CheckerMaker, theCpuStandsInForADeviceThatCannotBeOpenedOnceMore)
{
  EXPECT_EQ(ask(1).result.valid.size(), 1u);
  openWith([](const auto&) { throw DeviceLost("the GPU was reset"); });
  const CheckAnswer answer = ask(kLarge);
  EXPECT_EQ(answer.result.valid.size(), kLarge);
  EXPECT_EQ(answer.device, "CPU");
}

TEST_F(CheckerMaker, aDeviceThatHangsWhenItIsOpenedOnceMoreHoldsNobodyUp)
{
  EXPECT_EQ(ask(1).result.valid.size(), 1u);
  openWith([](const auto& repaired) { repaired.wait(); });
  EXPECT_EQ(ask(kLarge).result.valid.size(), kLarge);
  server().stop();
}
}  // namespace
}  // namespace gpu_planning_scene
