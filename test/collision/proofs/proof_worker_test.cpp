// While and after the proofs of a robot are made in the background, checkers answer as the exact checker does.

#include "collision/proofs/proof_worker.h"

#include <algorithm>
#include <cstdlib>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "collision/proofs/proof_scene.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kManyStates = 25000;  // more than are checked before proofs are made
constexpr std::size_t kEvery = 10;

/// The same neighbourhood for each state.
JointNeighbourhood around(const RobotModel& robot, std::size_t count)
{
  return {std::vector<JointTravel>(robot.joints().size(), {0.005, 0.02}), std::vector<std::uint32_t>(count, 0)};
}

/// The verdicts of every tenth state, one state at a time: so the exact checker decides them alone.
std::vector<std::uint8_t> exactVerdicts(const std::shared_ptr<const PlanningScene>& scene,
                                        const std::vector<double>& states, bool with_margins)
{
  CpuChecker checker(scene);
  const std::size_t width = scene->robot->variables().size();
  const JointNeighbourhood neighbourhood = around(*scene->robot, 1);
  std::vector<std::uint8_t> valid;
  for (std::size_t i = 0; i < states.size(); i += kEvery * width)
    valid.push_back(checker.check(states.data() + i, 1, "", with_margins ? &neighbourhood : nullptr).valid[0]);
  return valid;
}

void expectVerdicts(const std::vector<std::uint8_t>& expected, const std::vector<std::uint8_t>& valid)
{
  for (std::size_t i = 0; i < expected.size(); ++i)
    ASSERT_EQ(valid.at(kEvery * i), expected[i]) << "state " << kEvery * i << ", seed " << kSeed;
}

void compare(const std::shared_ptr<const RobotModel>& robot)
{
  const auto scene = proofScene(robot);
  std::mt19937_64 generator(kSeed);
  std::vector<double> states(kManyStates * robot->variables().size());
  for (std::size_t i = 0; i < kManyStates; ++i)
    robot->randomState(generator, states.data() + i * robot->variables().size());
  const std::vector<std::uint8_t> exact = exactVerdicts(scene, states, false);
  const std::vector<std::uint8_t> exact_near = exactVerdicts(scene, states, true);
  const auto free = std::count(exact.begin(), exact.end(), 1);
  EXPECT_GT(free, static_cast<std::ptrdiff_t>(exact.size() / 20));
  EXPECT_LT(free, static_cast<std::ptrdiff_t>(exact.size() * 19 / 20));
  EXPECT_LT(std::count(exact_near.begin(), exact_near.end(), 1), free);
  CpuChecker checker(scene);
  const JointNeighbourhood neighbourhood = around(*robot, kManyStates);
  for (int round = 0; round < 3; ++round)
  {
    SCOPED_TRACE("round " + std::to_string(round));
    expectVerdicts(exact, checker.check(states.data(), kManyStates).valid);
    expectVerdicts(exact_near, checker.check(states.data(), kManyStates, "", &neighbourhood).valid);
    if (round == 1)  // the second round has started to make the proofs
      waitForProofs();
  }
  std::uint64_t decided = 0;
  std::uint64_t alone = 0;
  for (const DecidedStates& stage : checker.report().decided)
  {
    decided += stage.states;
    alone += stage.by == "the exact checker alone" ? stage.states : 0;
  }
  EXPECT_EQ(decided, 6 * kManyStates);
  EXPECT_LT(alone, 5 * kManyStates);
  EXPECT_GE(alone, 16384u);
}

TEST(ProofWorker, ChangesNoVerdictOfCheckersInSeveralThreads)
{
  setenv("GPU_PLANNING_SCENE_PROOF_CACHE", "off", 1);
  std::vector<std::thread> threads;
  threads.emplace_back([] { compare(sliderRobot()); });
  threads.emplace_back([] { compare(sliderRobotOnFloor("planar")); });
  threads.emplace_back([] { compare(sliderRobotOnFloor("floating")); });
  for (std::thread& thread : threads)
    thread.join();
}
}  // namespace
}  // namespace gpu_planning_scene::core
