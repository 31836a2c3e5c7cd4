// Blocks of states have the verdicts of the exact checker, with each instruction set; and each proof holds.

#include <random>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "collision/exact/forest_cache.h"
#include "collision/filter/lane_checker.h"
#include "support/near_contact.h"
#include "support/repetitions.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint64_t kSeed = 41;

/// A scene with its proofs, and the exact checker.
class LaneProofs : public testing::TestWithParam<const char*>
{
 protected:
  void SetUp() override
  {
    if (const std::string missing = missingFor(GetParam()); !missing.empty())
      GTEST_SKIP() << "there is no " << missing;
    scene_ = testScene(GetParam());
    problem_ = std::make_shared<const CollisionProblem>(makeProblem(*scene_.scene, "", nullptr));
    traversal_ = forest_.traversalOf(problem_);
    RobotProver prover;
    std::shared_ptr<const RobotProofs> proofs;
    const auto publish = [&proofs](RobotProofs made) { proofs = std::make_shared<const RobotProofs>(std::move(made)); };
    prover.prove(robot(), *problem_, forest_.forest(), publish, [] { return false; });
    lanes_ = std::make_unique<const LaneScene>(scene_.scene->robot, *problem_, *forest_.forest(), proofs);
  }

  const RobotModel& robot() const { return *scene_.scene->robot; }

  /// Runs a kernel on all states and compares its proofs with the exact checker. Returns the number of proven states.
  std::size_t compare(const lanes::NamedKernel& kernel, const std::vector<double>& states)
  {
    const lanes::Model& model = lanes_->model();
    std::vector<float> floats((24 * lanes::kLanes) * model.frames.count + 3 * lanes::kLanes * model.bodies.count +
                              lanes::kBallNumbers * model.bodies.count);
    std::vector<std::uint8_t> placed(model.bodies.count);
    std::vector<std::uint32_t> open(lanes::kLanes * lanes_->pairCount());
    float* const frames = floats.data();
    float* const given = frames + 12 * lanes::kLanes * model.frames.count;
    float* const centers = given + 12 * lanes::kLanes * model.frames.count;
    const lanes::Scratch scratch = {
        frames, given, centers, centers + 3 * lanes::kLanes * model.bodies.count, placed.data(), open.data()};
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
        const std::vector<CpuTraversal::InstancePair> colliding = traversal_->collidingInstances(poses.data(), exact);
        if (block.proof[lane] == Proof::Apart)
          EXPECT_TRUE(colliding.empty()) << kernel.instructions << ", seed " << kSeed;
        if (block.proof[lane] == Proof::Colliding)
          EXPECT_EQ(std::count(colliding.begin(), colliding.end(), lanes_->instancesOf(block.pair[lane])), 1)
              << kernel.instructions << ", seed " << kSeed;
        proven += block.proof[lane] == Proof::None ? 0 : 1;
      }
    }
    return proven;
  }

  TestScene scene_;
  std::shared_ptr<const CollisionProblem> problem_;
  ForestCache forest_;
  std::unique_ptr<const CpuTraversal> traversal_;
  std::unique_ptr<const LaneScene> lanes_;
};

TEST_P(LaneProofs, HoldInRandomStatesWithEachInstructionSet)
{
  constexpr std::size_t kStates = repetitions(2000, 20000);
  const std::vector<double> states = scene_.randomStates(kStates, kSeed);
  for (const lanes::NamedKernel& kernel : lanes::availableKernels())
  {
    const std::size_t proven = compare(kernel, states);
    std::cout << kernel.instructions << ": " << proven << " of " << kStates << " states proven" << std::endl;
    EXPECT_GT(proven, kStates / 3);
  }
}
INSTANTIATE_TEST_SUITE_P(Scenes, LaneProofs, testing::Values("kr5", "kr5_crowded", "ur5_cage", "wam", "arm_boxes"));
}  // namespace
}  // namespace gpu_planning_scene::core
