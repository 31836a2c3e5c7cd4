// Compares every checker with FCL on real robots. They must agree except where FCL is known to be wrong.

#include <algorithm>
#include <iostream>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "support/checkers.h"
#include "support/fcl_agreement.h"
#include "support/kept_trees.h"
#include "support/repetitions.h"
#include "support/seed.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kComparedStates = repetitions(150, 2000);

/// FCL with the scene's problem. It is made once per process, because building FCL's trees takes a while.
FclPeer& fclPeerOf(const TestScene& scene)
{
  static std::map<std::string, FclPeer> made;
  const auto known = made.find(scene.name);
  if (known != made.end())
    return known->second;
  return made.try_emplace(scene.name, std::make_shared<const CollisionProblem>(makeProblem(*scene.scene, "", nullptr)))
      .first->second;
}

class Agreement : public testing::TestWithParam<std::tuple<const char*, std::string>>
{
};

TEST_P(Agreement, WithFclInRandomStates)
{
  const auto& [method, name] = GetParam();
  if (const std::string missing = missingFor(name); !missing.empty())
    GTEST_SKIP() << "there is no " << missing;
  const TestScene& scene = testScene(name);
  keepTrees(*scene.scene);
  const std::vector<double> states = scene.randomStates(kComparedStates, kSeed);
  StateChecker& checker = checkerOf(method, *scene.scene);
  const BatchResult result = checker.check(states.data(), kComparedStates);

  const FclAgreement agreement = compareWithFcl(fclPeerOf(scene), *scene.scene, states, result);
  std::cout << name << " on " << checker.deviceName() << ", seed " << kSeed << ": " << agreement << std::endl;
  // Otherwise the comparison shows little.
  ASSERT_GE(agreement.free, kComparedStates / 10);
  ASSERT_LE(agreement.free, kComparedStates * 9 / 10);
  ASSERT_GE(agreement.world_hits, kComparedStates / 20);
  EXPECT_TRUE(agreement.failures.empty());
}

std::string nameOf(const testing::TestParamInfo<Agreement::ParamType>& parameter)
{
  return std::string(std::get<0>(parameter.param)) + "_" + std::get<1>(parameter.param);
}
/// The scenes of the benchmark that are not test scenes.
std::vector<std::string> otherSceneNames()
{
  std::vector<std::string> others;
  for (const std::string& name : benchmarkSceneNames())
    if (std::find(testSceneNames().begin(), testSceneNames().end(), name) == testSceneNames().end())
      others.push_back(name);
  return others;
}
INSTANTIATE_TEST_SUITE_P(OfTheBenchmark, Agreement,
                         testing::Combine(testing::Values("cpu"), testing::ValuesIn(otherSceneNames())), nameOf);

INSTANTIATE_TEST_SUITE_P(Checkers, Agreement,
                         testing::Combine(testing::Values("cpu", "breadth_first", "work_queue"),
                                          testing::ValuesIn(testSceneNames())),
                         nameOf);
}  // namespace
}  // namespace gpu_planning_scene::core
