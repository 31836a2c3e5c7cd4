// Joint tables and balls on the GPU decide most pairs, and never otherwise than the exact checker.

#include <algorithm>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "collision/gpu/gpu_checker.h"
#include "collision/gpu/sliding_balls.h"
#include "collision/proofs/proven_scene.h"
#include "support/near_contact.h"
#include "support/repetitions.h"
#include "support/seed.h"
#include "support/shader_folder.h"

namespace gpu_planning_scene::core
{
namespace
{
ProvenScene provenSlidingBalls()
{
  const std::shared_ptr<PlanningScene> scene = slidingBalls();
  const std::size_t width = scene->robot->variables().size();
  ProvenScene made =
      prove({"sliding_balls", scene, std::vector<double>(width, -kSlide), std::vector<double>(width, kSlide)});
  RobotProofs proofs = *made.proofs;
  proofs.covers = exactCovers(*made.problem, *scene->robot);
  made.proofs = std::make_shared<const RobotProofs>(proofs);
  return made;
}

/// The generated arm carries two objects above a floor that is tilted by 1e-4 radians, among boxes with padding.
ProvenScene provenCarryingArm()
{
  const TestScene& arm = testScene("arm_boxes");
  auto scene = std::make_shared<PlanningScene>(*arm.scene);
  const int hand = static_cast<int>(scene->robot->links().size()) - 1;
  const auto carry = [&](const std::string& id, const Shape& shape, const Eigen::Vector3d& place)
  {
    AttachedObject carried;
    carried.object.id = id;
    carried.object.pose = Eigen::Translation3d(place) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX());
    carried.object.shapes = {{shape, Eigen::Isometry3d::Identity()}};
    carried.link = hand;
    scene->attached.push_back(carried);
  };
  carry("tray", Box{{0.3, 0.2, 0.02}}, {0.1, 0.0, 0.1});
  carry("cup", tessellate(Cylinder{0.04, 0.1}).mesh, {0.1, 0.0, 0.18});
  for (WorldObject& object : scene->objects)
    object.padding = 0.01;
  scene->objects.push_back({"floor",
                            Eigen::Isometry3d(Eigen::AngleAxisd(1e-4, Eigen::Vector3d::UnitY())),
                            {{HalfSpace{Eigen::Vector3d::UnitZ(), -0.2}, Eigen::Isometry3d::Identity()}},
                            0.0});
  return prove({"carrying_arm", scene, arm.lower, arm.upper});
}

const ProvenScene& provenOwnOr(const std::string& name)
{
  static const ProvenScene balls = provenSlidingBalls();
  static const ProvenScene carrying = provenCarryingArm();
  return name == "sliding_balls" ? balls : name == "carrying_arm" ? carrying : provenScene(name);
}

/// The GPU's checks of a scene, with or without proofs.
class GpuProofsOfScenes : public testing::TestWithParam<const char*>
{
 protected:
  void SetUp() override
  {
    const std::string name = GetParam();
    const bool is_own = name == "sliding_balls" || name == "carrying_arm";
    if (!is_own && !missingFor(name).empty())
      GTEST_SKIP() << "there is no " << missingFor(name);
    proven_ = &provenOwnOr(name);
    for (const bool proofs : {false, true})
    {
      BatchCheckerOptions options;
      options.max_batch = 2048;
      checkers_[proofs ? 1 : 0] = std::make_unique<GpuChecker>(options);
      checkers_[proofs ? 1 : 0]->setProblem(proven_->problem, proven_->scene.scene->robot);
    }
    checkers_[1]->useProofs(proven_->ofDevice());
    EXPECT_EQ(checkers_[1]->fault(), "");
  }

  /// The number of traversed pairs with proofs, relative to the number without proofs.
  double traversedShare() const
  {
    return static_cast<double>(checkers_[1]->lastWork().traversed) /
           static_cast<double>(checkers_[0]->lastWork().traversed);
  }

  /// Compares all verdicts, with and without proofs, with the exact checker.
  void compare(const std::vector<double>& states, const Margins* margins)
  {
    const std::size_t count = states.size() / robot().variables().size();
    BatchResult without;
    checkers_[0]->check(states.data(), count, without, margins);
    BatchResult with;
    checkers_[1]->check(states.data(), count, with, margins);
    std::vector<Eigen::Isometry3d> poses(robot().links().size());
    ExactChecker::Scratch scratch;
    for (std::size_t i = 0; i < count; ++i)
    {
      robot().linkPoses(states.data() + i * robot().variables().size(), poses.data());
      const double* const row = margins ? margins->of(i) : nullptr;
      const bool is_free = !proven_->exact->firstCollision(poses.data(), scratch, row);
      EXPECT_EQ(without.valid[i] != 0, is_free) << "state " << i << ", without proofs, seed " << kSeed;
      EXPECT_EQ(with.valid[i] != 0, is_free) << "state " << i << ", with proofs, seed " << kSeed;
      if (with.valid[i] != 0 || margins)
        continue;
      std::vector<BodyPair> colliding;
      for (const InstancePair& pair : proven_->exact->collidingInstances(poses.data(), scratch))
        colliding.push_back(bodiesOf(*proven_->problem, pair));
      EXPECT_EQ(std::count(colliding.begin(), colliding.end(), with.colliding[i]) > 0, true)
          << "state " << i << ": the reported pair does not collide, seed " << kSeed;
    }
  }

  const RobotModel& robot() const { return *proven_->scene.scene->robot; }

  const ProvenScene* proven_ = nullptr;
  std::array<std::unique_ptr<GpuChecker>, 2> checkers_;  // [0]: without proofs, [1]: with proofs
};

TEST_P(GpuProofsOfScenes, DecideMostPairsOfRandomStates)
{
  compare(proven_->scene.randomStates(repetitions(400, 40'000), kSeed), nullptr);
  std::cout << "traversed pairs: " << traversedShare() << " of those without proofs" << std::endl;
  EXPECT_LT(traversedShare(), 0.5);
}

TEST_P(GpuProofsOfScenes, DecideNoPairWronglyNearContact)
{
  compare(nearContactStates(proven_->scene, repetitions(60, 1000), kSeed + 1), nullptr);
}

TEST_P(GpuProofsOfScenes, KeepTheMarginsOfPairs)
{
  constexpr double kLargestMargin = 0.05;  // metres
  constexpr std::uint32_t kRows = 7;
  const std::size_t count = repetitions(250, 10'000);
  std::mt19937_64 generator(kSeed + 2);
  std::uniform_real_distribution<double> distances(0.0, kLargestMargin);
  Margins margins;
  margins.width = proven_->problem->robot.size() + proven_->problem->self_pairs.size();
  margins.values.resize(kRows * margins.width);
  std::generate(margins.values.begin(), margins.values.end(), [&] { return distances(generator); });
  margins.within.assign(count, 1);
  for (std::uint32_t i = 0; i < count; ++i)
    margins.rows.push_back(i % kRows);
  compare(proven_->scene.randomStates(count, kSeed + 3), &margins);
  EXPECT_LT(traversedShare(), 0.9);
}

TEST(GpuProofs, FramesThatTheDeviceMisplacesAreFound)
{
  const ProvenScene& proven = provenScene("arm_boxes");
  const ShaderFolder shaders;
  shaders.replace("proofs/joint_kinematics.glsl", "-1.66666667e-1", "-1.666e-1");
  BatchCheckerOptions options;
  options.shader_folder = shaders.path();
  GpuChecker checker(options);
  checker.setProblem(proven.problem, proven.scene.scene->robot);
  EXPECT_EQ(checker.fault(), "");
  checker.useProofs(proven.ofDevice());
  EXPECT_NE(checker.fault().find("is elsewhere than the robot model says; trees decide all pairs"), std::string::npos)
      << checker.fault();
}

#ifdef GPS_SOAK
INSTANTIATE_TEST_SUITE_P(Scenes, GpuProofsOfScenes,
                         testing::Values("sliding_balls", "carrying_arm", "kr5", "kr5_crowded", "ur5_cage", "wam",
                                         "arm_boxes", "arm_driven", "panda_boxes"));
#else
INSTANTIATE_TEST_SUITE_P(Scenes, GpuProofsOfScenes,
                         testing::Values("sliding_balls", "carrying_arm", "kr5", "arm_boxes", "arm_driven"));
#endif
}  // namespace
}  // namespace gpu_planning_scene::core
