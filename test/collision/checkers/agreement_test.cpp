// Compares every checker with FCL on real robots. They must agree except where FCL is known to be wrong.

#include <functional>
#include <iostream>
#include <tuple>

#include <gtest/gtest.h>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "support/fcl_agreement.h"
#include "support/kept_trees.h"
#include "support/repetitions.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kStates = repetitions(400, 2000);
constexpr std::uint64_t kSeed = 20261121;

using Scene = std::shared_ptr<const PlanningScene>;

/// A named way to make a checker.
struct Implementation
{
  std::string name;
  std::function<std::unique_ptr<StateChecker>(Scene)> make;
};

void PrintTo(const Implementation& implementation, std::ostream* out)
{
  *out << implementation.name;
}

const Implementation kCpu = {"Cpu", [](Scene scene) { return std::make_unique<CpuChecker>(std::move(scene)); }};

std::unique_ptr<StateChecker> onGpu(Scene scene, Traversal traversal)
{
  BatchCheckerOptions options;
  options.traversal = traversal;
  options.cpu_below = 0;
  return std::make_unique<BatchChecker>(std::move(scene), options);
}

const Implementation kBreadthFirst = {"BreadthFirst",
                                      [](Scene scene) { return onGpu(std::move(scene), Traversal::BreadthFirst); }};
const Implementation kWorkQueue = {"WorkQueue",
                                   [](Scene scene) { return onGpu(std::move(scene), Traversal::WorkQueue); }};

class Agreement : public testing::TestWithParam<std::tuple<Implementation, std::string>>
{
};

TEST_P(Agreement, WithFclInRandomStates)
{
  const auto& [implementation, name] = GetParam();
  if (const std::string missing = missingFor(name); !missing.empty())
    GTEST_SKIP() << "there is no " << missing;
  const TestScene& scene = testScene(name);
  keepTrees(*scene.scene);
  const std::vector<double> states = scene.randomStates(kStates, kSeed);
  const auto checker = implementation.make(scene.scene);
  const BatchResult result = checker->check(states.data(), kStates);

  const FclAgreement agreement = compareWithFcl(*scene.scene, states, result);
  std::cout << name << " on " << checker->deviceName() << ", seed " << kSeed << ": " << agreement << std::endl;
  // Otherwise the comparison shows little.
  ASSERT_GE(agreement.free, kStates / 10);
  ASSERT_LE(agreement.free, kStates * 9 / 10);
  ASSERT_GE(agreement.world_hits, kStates / 20);
  EXPECT_TRUE(agreement.failures.empty());
}

std::string nameOf(const testing::TestParamInfo<Agreement::ParamType>& parameter)
{
  return std::get<0>(parameter.param).name + "_" + std::get<1>(parameter.param);
}
INSTANTIATE_TEST_SUITE_P(Checkers, Agreement,
                         testing::Combine(testing::Values(kCpu, kBreadthFirst, kWorkQueue),
                                          testing::ValuesIn(testSceneNames())),
                         nameOf);
}  // namespace
}  // namespace gpu_planning_scene::core
