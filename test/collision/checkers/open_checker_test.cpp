// A program that needs answers and not a certain device gets right answers when its device fails, and one warning.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "collision/checkers/open_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/device.h"
#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "support/shader_folder.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
using Scene = std::shared_ptr<const PlanningScene>;

class OpenChecker : public testing::Test
{
 protected:
  /// The scene with one ball more.
  Scene changedScene() const
  {
    auto changed = std::make_shared<PlanningScene>(*test_.scene);
    changed->revision += 1;
    changed->objects.push_back({"ball",
                                Eigen::Isometry3d(Eigen::Translation3d(0.3, 0.2, 0.4)),
                                {{Sphere{0.17}, Eigen::Isometry3d::Identity()}}});
    return changed;
  }

  std::unique_ptr<StateChecker> open(const std::string& shaders, const std::string& device = "auto")
  {
    BatchCheckerOptions options;
    options.device = device;
    options.device_only = true;
    options.shader_folder = shaders;
    return openChecker(test_.scene, options, [this](const std::string& line) { warnings_.push_back(line); });
  }

  void expectRight(StateChecker& checker, const Scene& scene)
  {
    const BatchResult result = checker.check(states_.data(), kCount);
    EXPECT_EQ(result.valid, CpuChecker(scene).check(states_.data(), kCount).valid);
    EXPECT_EQ(result.revision, scene->revision);
  }

  void expectWarning(const std::string& begin, const std::string& reason) const
  {
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_EQ(warnings_[0].rfind(begin + ", so the CPU checks the states: ", 0), 0u) << warnings_[0];
    EXPECT_NE(warnings_[0].find(reason), std::string::npos) << warnings_[0];
  }

  static constexpr std::size_t kCount = 500;
  const TestScene& test_ = testScene("arm_boxes");
  const std::vector<double> states_ = test_.randomStates(kCount, 5);
  std::vector<std::string> warnings_;
};

/// Changes of shaders that build wrong trees only if one mesh is built alone, with a part of their error.
const std::vector<std::array<std::string, 4>> kFaults = {
    {"tree_build/scan.comp", "rounds[next + ROUND_CLUSTERS] = remaining;",
     "rounds[next + ROUND_CLUSTERS] = mesh_count == 1u ? 0u : remaining;", "built 0 subtrees instead of 1 trees"},
    {"tree_build/layout_pairs.comp", "place(left, ", "if (mesh_count != 1u) place(left, ", "built wrong trees"},
};

TEST_F(OpenChecker, ADeviceThatBuildsWrongTreesAtASceneChangeIsReplacedByTheCpu)
{
  for (const auto& [file, text, by, error] : kFaults)
  {
    const ShaderFolder shaders;
    shaders.replace(file, text, by);
    const auto checker = open(shaders.path());
    expectRight(*checker, test_.scene);
    EXPECT_NE(checker->deviceName(), "CPU");
    EXPECT_TRUE(warnings_.empty());
    const Scene changed = changedScene();
    checker->setScene(changed);
    expectRight(*checker, changed);
    expectRight(*checker, changed);
    EXPECT_EQ(checker->deviceName(), "CPU");
    EXPECT_EQ(checker->deviceWarning().rfind("the device has failed, so the CPU checks the states: ", 0), 0U);
    EXPECT_NE(checker->deviceWarning().find(error), std::string::npos) << checker->deviceWarning();
  }
}

TEST_F(OpenChecker, ADeviceThatBuildsWrongTreesAtTheStartIsReplacedByTheCpu)
{
  const ShaderFolder shaders;
  shaders.replace("tree_build/gather_triangles.comp", "vertices[at + 2u]", "vertices[at]");
  const auto checker = open(shaders.path());
  expectRight(*checker, test_.scene);
  const Scene changed = changedScene();
  checker->setScene(changed);
  expectRight(*checker, changed);
  EXPECT_EQ(checker->deviceName(), "CPU");
  expectWarning("no device can be used", "built wrong trees");
}

/// llvmpipe is slower than the cores that it runs on.
TEST_F(OpenChecker, WithoutAGpuTheCpuAnswersUnlessASoftwareDeviceIsNamed)
{
  const std::vector<Device> devices = listDevices();
  if (devices.empty() ||
      !std::all_of(devices.begin(), devices.end(), [](const Device& device) { return device.software; }))
    GTEST_SKIP() << "needs a machine with a software device and without a GPU";
  BatchCheckerOptions options;
  const auto warn = [this](const std::string& line) { warnings_.push_back(line); };
  const auto by_default = openChecker(test_.scene, options, warn);
  EXPECT_EQ(by_default->deviceName(), "CPU");
  EXPECT_EQ(by_default->deviceWarning(), "");
  EXPECT_EQ(by_default->check(states_.data(), kCount).device_states, 0U);
  options.device = "software";
  const auto by_name = openChecker(test_.scene, options, warn);
  EXPECT_EQ(by_name->deviceName(), devices.front().renderer);
  for (const std::size_t count : {std::size_t(1), kCount})
  {
    const BatchResult result = by_name->check(states_.data(), count);
    EXPECT_EQ(result.device_states + result.undecided_states, count);
  }
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(OpenChecker, ADeviceThatTheUserHasNamedIsNotReplaced)
{
  const ShaderFolder shaders;
  shaders.replace("tree_build/gather_triangles.comp", "vertices[at + 2u]", "vertices[at]");
  const std::string device = std::to_string(listDevices().at(0).index);
  EXPECT_NE(errorOf([&] { open(shaders.path(), device); }).find("built wrong trees"), std::string::npos);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(OpenChecker, AWrongInputIsAnErrorAndNoFaultOfTheDevice)
{
  BatchCheckerOptions options;
  const auto warn = [this](const std::string& line) { warnings_.push_back(line); };
  options.max_batch = 0;
  EXPECT_NE(errorOf([&] { openChecker(test_.scene, options, warn); }).find("max_batch"), std::string::npos);
  options = {};
  const auto checker = openChecker(test_.scene, options, warn);
  auto wrong = std::make_shared<PlanningScene>(*test_.scene);
  wrong->objects.at(0).pose.translation().x() = std::nan("");
  EXPECT_THROW(checker->setScene(wrong), Error);
  expectRight(*checker, test_.scene);
  EXPECT_TRUE(warnings_.empty());
}

TEST(SelectedDevices, AreNamedWithPlusBetweenThem)
{
  EXPECT_EQ(devicesOf("0"), std::vector<std::string>{"0"});
  EXPECT_EQ(devicesOf("0+software"), (std::vector<std::string>{"0", "software"}));
  for (const char* selection : {"", "0+", "+0", "0++1"})
    EXPECT_NE(errorOf([&] { devicesOf(selection); }).find("empty part"), std::string::npos) << selection;
}
}  // namespace
}  // namespace gpu_planning_scene::core
