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

class LaneProofs : public testing::TestWithParam<const char*>
{
 protected:
  void SetUp() override
  {
    if (const std::string missing = missingFor(GetParam()); !missing.empty())
      GTEST_SKIP() << "there is no " << missing;
    proven_ = &provenScene(GetParam());
  }

  const RobotModel& robot() const { return *proven_->scene.scene->robot; }

  /// Runs a kernel on all states and compares its proofs with the exact checker. Returns the number of proven states.
  std::size_t compare(const lanes::NamedKernel& kernel, const std::vector<double>& states)
  {
    const lanes::Model& model = proven_->lanes->model();
    const std::size_t poses_size = std::size_t{12} * lanes::kLanes * model.frames.count;
    const std::size_t centers_size = std::size_t{3} * lanes::kLanes * model.bodies.count;
    std::vector<float> floats(2 * poses_size + centers_size + std::size_t{lanes::kBallNumbers} * model.bodies.count);
    std::vector<std::uint8_t> placed(model.bodies.count);
    std::vector<std::uint32_t> open(lanes::kLanes * proven_->lanes->pairCount());
    float* const frames = floats.data();
    float* const given = frames + poses_size;
    float* const centers = given + poses_size;
    const lanes::Scratch scratch = {frames, given, centers, centers + centers_size, placed.data(), open.data()};
    std::vector<Eigen::Isometry3d> poses(robot().links().size());
    CpuTraversal::Scratch exact;
    const std::size_t width = robot().variables().size();
    const std::size_t count = states.size() / width;
    std::size_t proven = 0;
    for (std::size_t first = 0; first < count; first += lanes::kLanes)
    {
      const int size = static_cast<int>(std::min<std::size_t>(lanes::kLanes, count - first));
      lanes::Block block;
      kernel.kernel(model, states.data() + first * width, size, scratch, block);
      for (int lane = 0; lane < size; ++lane)
      {
        robot().linkPoses(states.data() + (first + static_cast<std::size_t>(lane)) * width, poses.data());
        const std::vector<CpuTraversal::InstancePair> colliding =
            proven_->exact->collidingInstances(poses.data(), exact);
        if (block.proof[lane] == Proof::Apart)
          EXPECT_TRUE(colliding.empty()) << kernel.instructions << ", seed " << kSeed;
        if (block.proof[lane] == Proof::Colliding)
          EXPECT_EQ(std::count(colliding.begin(), colliding.end(), proven_->lanes->instancesOf(block.pair[lane])), 1)
              << kernel.instructions << ", seed " << kSeed;
        proven += block.proof[lane] == Proof::None ? 0 : 1;
      }
    }
    return proven;
  }

  const ProvenScene* proven_ = nullptr;
};

TEST_P(LaneProofs, HoldInRandomStatesWithEachInstructionSet)
{
  constexpr std::size_t kStates = repetitions(2000, 20000);
  const std::vector<double> states = proven_->scene.randomStates(kStates, kSeed);
  for (const lanes::NamedKernel& kernel : lanes::availableKernels())
  {
    const std::size_t proven = compare(kernel, states);
    std::cout << kernel.instructions << ": " << proven << " of " << kStates << " states proven" << std::endl;
    EXPECT_GT(proven, kStates / 3);
  }
}
#ifdef GPS_SOAK
INSTANTIATE_TEST_SUITE_P(Scenes, LaneProofs, testing::Values("kr5", "kr5_crowded", "ur5_cage", "wam", "arm_boxes"));
#else
INSTANTIATE_TEST_SUITE_P(Scenes, LaneProofs, testing::Values("kr5", "arm_boxes"));
#endif
}  // namespace
}  // namespace gpu_planning_scene::core
