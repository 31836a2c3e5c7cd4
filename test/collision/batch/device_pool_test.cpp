// Devices join a batch if it then ends earlier, as far as earlier batches show.

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "collision/batch/device_pool.h"
#include "collision/batch/scripted_device.h"
#include "collision/bounds/problem_maker.h"

namespace gpu_planning_scene::core
{
namespace
{
class DevicePoolTest : public testing::Test
{
 protected:
  DevicePoolTest()
  {
    const auto scene = cartScene(1.0, 1);
    const auto problem = std::make_shared<const CollisionProblem>(makeProblem(*scene, "", nullptr));
    pool_.open({scene->robot, problem, problem, nullptr}, false);
  }

  static std::vector<std::unique_ptr<DeviceWorker>> workers()
  {
    std::vector<std::unique_ptr<DeviceWorker>> made;
    made.push_back(std::make_unique<DeviceWorker>(
        [] { return std::make_unique<ScriptedDevice>(std::make_shared<DeviceScript>()); }, DeviceLimits()));
    return made;
  }

  /// A batch of 10,000 states of which the device answers the first 4,000 after `latency`, and the cores the others, at
  /// `core_rate` states per second.
  void learn(std::chrono::milliseconds latency, double core_rate)
  {
    constexpr std::size_t kStatesOfBatch = 10'000;
    Batch batch(kStatesOfBatch, std::nullopt, 1);
    batch.setDeviceRows(
        std::make_unique<const DeviceRows>(nullptr, kStatesOfBatch, 0, [](std::size_t) { return true; }));
    batch.join(0);
    const StateRange part = batch.takeForDevice(0, 4'000, 1.0);
    std::this_thread::sleep_for(latency);
    batch.endAnswer(batch.beginAnswer(0, part), {});
    pool_.learn(batch, "", kStatesOfBatch - part.count, static_cast<double>(kStatesOfBatch - part.count) / core_rate);
  }

  /// A batch in which the device takes no part.
  void learnWithoutDevice() { pool_.learn(Batch(10'000, std::nullopt, 1), "", 0, 0.0); }

  DevicePool pool_{workers(), false};
};

TEST_F(DevicePoolTest, BeforeThePacesAreKnownDevicesJoinLargeBatches)
{
  EXPECT_FALSE(pool_.suits("", 4'095));
  EXPECT_TRUE(pool_.suits("", 4'096));
}

TEST_F(DevicePoolTest, TheFirstBatchOfADeviceSaysNothing)
{
  learn(std::chrono::milliseconds(0), 1'000.0);
  EXPECT_FALSE(pool_.suits("", 1'000)) << "the driver may have compiled in it";
  learn(std::chrono::milliseconds(0), 1'000.0);
  EXPECT_TRUE(pool_.suits("", 1'000)) << "the cores need a second, and the device begins at once";
  EXPECT_FALSE(pool_.suits("arm", 1'000)) << "another group has other paces";
}

TEST_F(DevicePoolTest, ADeviceIsLeftOutIfTheCoresEndBeforeItsFirstAnswer)
{
  for (int i = 0; i < 2; ++i)
    learn(std::chrono::milliseconds(50), 1e6);
  EXPECT_FALSE(pool_.suits("", 90'000));
  EXPECT_TRUE(pool_.suits("", 10'000'000));
}

TEST_F(DevicePoolTest, AnOldLatencyIsForgottenLittleByLittle)
{
  for (int i = 0; i < 2; ++i)
    learn(std::chrono::milliseconds(50), 1e6);
  ASSERT_FALSE(pool_.suits("", 90'000));
  for (int i = 0; i < 50; ++i)
    learnWithoutDevice();
  EXPECT_TRUE(pool_.suits("", 90'000));
}

TEST_F(DevicePoolTest, BetterProofsAndAnotherRobotMakeThePacesUnknown)
{
  for (const bool by_proofs : {true, false})
  {
    for (int i = 0; i < 2; ++i)
      learn(std::chrono::milliseconds(0), 1'000.0);
    ASSERT_TRUE(pool_.suits("", 1'000));
    if (by_proofs)
      pool_.noteProofs("", ProofStage::All);
    else
      pool_.forgetPaces();
    EXPECT_FALSE(pool_.suits("", 1'000));
    pool_.noteProofs("", ProofStage::None);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
