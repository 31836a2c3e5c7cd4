// Blocks of states have the verdicts of the exact checker, with each instruction set; and each proof holds.

#include <random>

#include <gtest/gtest.h>

#include "collision/filter/lane_kernel.h"
#include "collision/filter/proven_scene.h"
#include "support/repetitions.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint64_t kSeed = 41;

using InstancePairs = std::vector<CpuTraversal::InstancePair>;

/// The pairs that collide in each state.
std::vector<InstancePairs> collidingPairs(const ProvenScene& proven, const std::vector<double>& states)
{
  const RobotModel& robot = *proven.scene.scene->robot;
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  CpuTraversal::Scratch scratch;
  std::vector<InstancePairs> all;
  for (std::size_t i = 0; i < states.size(); i += robot.variables().size())
  {
    robot.linkPoses(states.data() + i, poses.data());
    all.push_back(proven.exact->collidingInstances(poses.data(), scratch));
  }
  return all;
}

/// Runs a kernel on all states and compares its proofs with the pairs that collide. Returns the number of proven
/// states.
std::size_t compare(const ProvenScene& proven, const lanes::NamedKernel& kernel, const std::vector<double>& states,
                    const std::vector<InstancePairs>& colliding)
{
  const lanes::Model& model = proven.lanes->model();
  const std::size_t poses_size = std::size_t{12} * lanes::kLanes * model.frames.count;
  const std::size_t centers_size = std::size_t{3} * lanes::kLanes * model.bodies.count;
  std::vector<float> floats(2 * poses_size + centers_size + std::size_t{lanes::kBallNumbers} * model.bodies.count);
  std::vector<std::uint8_t> placed(model.bodies.count);
  std::vector<std::uint32_t> open(lanes::kLanes * proven.lanes->pairCount());
  std::vector<lanes::Trial> trials(std::size_t{lanes::kLevels} * proven.lanes->pairCount());
  float* const frames = floats.data();
  float* const given = frames + poses_size;
  float* const centers = given + poses_size;
  const lanes::Scratch scratch = {frames,        given,       centers,      centers + centers_size,
                                  placed.data(), open.data(), trials.data()};
  const std::size_t width = states.size() / colliding.size();
  std::size_t proven_states = 0;
  for (std::size_t first = 0; first < colliding.size(); first += lanes::kLanes)
  {
    const int size = static_cast<int>(std::min<std::size_t>(lanes::kLanes, colliding.size() - first));
    std::fill(trials.begin(), trials.end(), lanes::Trial{});  // so that no level of balls is left out
    lanes::Block block;
    kernel.kernel(model, states.data() + first * width, size, scratch, block);
    for (int lane = 0; lane < size; ++lane)
    {
      const InstancePairs& pairs = colliding[first + static_cast<std::size_t>(lane)];
      if (block.proof[lane] == Proof::Apart)
        EXPECT_TRUE(pairs.empty()) << kernel.instructions << ", seed " << kSeed;
      if (block.proof[lane] == Proof::Colliding)
        EXPECT_EQ(std::count(pairs.begin(), pairs.end(), proven.lanes->instancesOf(block.pair[lane])), 1)
            << kernel.instructions << ", seed " << kSeed;
      proven_states += block.proof[lane] == Proof::None ? 0 : 1;
    }
  }
  return proven_states;
}

TEST_P(ProvenScenes, ProofsHoldInRandomStatesWithEachInstructionSet)
{
  constexpr std::size_t kStates = repetitions(2000, 20000);
  const std::vector<double> states = proven_->scene.randomStates(kStates, kSeed);
  const std::vector<InstancePairs> colliding = collidingPairs(*proven_, states);
  for (const lanes::NamedKernel& kernel : lanes::availableKernels())
  {
    const std::size_t proven = compare(*proven_, kernel, states, colliding);
    std::cout << kernel.instructions << ": " << proven << " of " << kStates << " states proven" << std::endl;
    EXPECT_GT(proven, kStates / 3);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
