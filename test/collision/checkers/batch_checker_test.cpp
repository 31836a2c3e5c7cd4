// The batch checker's answers do not depend on the batches and order of the states. A refused call changes nothing.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "collision/checkers/open_checker.h"
#include "collision/cpu/cpu_scene.h"
#include "collision/gpu/sliding_balls.h"
#include "collision/proofs/proof_worker.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "model/model_testing.h"
#include "support/kept_trees.h"
#include "support/repetitions.h"
#include "support/seed.h"
#include "support/shader_folder.h"
#include "support/software_device.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
BatchCheckerOptions with(Traversal traversal, std::size_t max_batch = 16384)
{
  BatchCheckerOptions options;
  options.traversal = traversal;
  options.max_batch = max_batch;
  options.device_only = true;
  return options;
}

class Invariance : public testing::TestWithParam<std::string>
{
};

TEST_P(Invariance, ValidIsTheSameForTraversalsBatchSizesAndOrders)
{
  if (const std::string missing = missingFor(GetParam()); !missing.empty())
    GTEST_SKIP() << "there is no " << missing;
  const TestScene& scene = testScene(GetParam());
  keepTrees(*scene.scene);
  // All batch sizes check the same states. Small batches check fewer of them, to save time.
  constexpr std::size_t kStates = repetitions(1100, 16384);
  const std::vector<double> states = scene.randomStates(kStates, kSeed);
  const std::size_t width = scene.scene->robot->variables().size();
  BatchChecker reference(scene.scene, with(Traversal::WorkQueue));
  const std::vector<std::uint8_t> valid = reference.check(states.data(), kStates).valid;
  for (const Traversal traversal : {Traversal::BreadthFirst, Traversal::WorkQueue})
    for (const std::size_t batch : {std::size_t{1}, std::size_t{7}, std::size_t{64}, std::size_t{1024}, kStates})
    {
      const std::size_t count = std::min<std::size_t>(kStates, batch * repetitions<std::size_t>(8, 64));
      BatchChecker checker(scene.scene, with(traversal, batch));
      const BatchResult result = checker.check(states.data(), count);
      EXPECT_TRUE(std::equal(result.valid.begin(), result.valid.end(), valid.begin()))
          << "batches of " << batch << ", seed " << kSeed;
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(result.colliding[i][0] < 0, result.valid[i] == 1);
    }
  std::vector<std::size_t> order(kStates);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(kSeed));
  std::vector<double> shuffled;
  for (const std::size_t row : order)
    shuffled.insert(shuffled.end(), &states[row * width], &states[row * width] + width);
  const BatchResult result = reference.check(shuffled.data(), kStates);
  for (std::size_t i = 0; i < kStates; ++i)
    ASSERT_EQ(result.valid[i], valid[order[i]]) << "state " << order[i] << ", seed " << kSeed;
}
INSTANTIATE_TEST_SUITE_P(Scenes, Invariance, testing::Values("kr5", "ur5_bookshelf_tall"),
                         [](const auto& parameter) { return parameter.param; });

class BatchCheckerTest : public testing::Test
{
 protected:
  void SetUp() override
  {
    // An arm of two links and a post. No files are needed.
    const std::string urdf = R"(<robot name="arm">
      <link name="base"><collision><geometry><box size="0.2 0.2 0.1"/></geometry></collision></link>
      <link name="upper"><collision><origin xyz="0.3 0 0"/><geometry><box size="0.4 0.05 0.05"/></geometry></collision></link>
      <link name="lower"><collision><origin xyz="0.2 0 0"/><geometry><cylinder radius="0.02" length="0.3"/></geometry></collision></link>
      <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.2"/><axis xyz="0 1 0"/>
        <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
      <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="0.6 0 0"/><axis xyz="0 0 1"/></joint>
    </robot>)";
    const std::string srdf = R"(<robot name="arm"><group name="wrist"><joint name="elbow"/></group>
      <disable_collisions link1="base" link2="upper" reason="Adjacent"/>
      <disable_collisions link1="upper" link2="lower" reason="Adjacent"/></robot>)";
    auto made = std::make_shared<PlanningScene>(RobotModel::fromXml(urdf, srdf, {}));
    made->objects.push_back(
        {"post", Eigen::Isometry3d(Eigen::Translation3d(0.67, 0.2, 0.2)), {{Box{{0.1, 0.1, 0.1}}}}});
    made->revision = 41;
    scene_ = made;
  }

  std::shared_ptr<const PlanningScene> scene_;
  std::vector<double> touching_ = {0.0, 1.2};  // the lower arm swings into the post
  std::vector<double> free_ = {0.0, -1.2};
};

/// The device then has no shapes at all, because no state within the limits reaches the object.
TEST(BatchChecker, StatesOutsideTheLimitsCollideWithWhatNoStateWithinThemReaches)
{
  const auto robot = robotOf(R"(
    <link name="rail"/>
    <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    <joint name="slide" type="prismatic"><parent link="rail"/><child link="cart"/><axis xyz="1 0 0"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>)");
  PlanningScene scene(robot);
  scene.objects = {{"far", Eigen::Isometry3d(Eigen::Translation3d(3.5, 0.0, 0.0)), {{Box{{0.5, 1, 1}}}}}};
  BatchChecker checker(std::make_shared<const PlanningScene>(scene), with(Traversal::WorkQueue));
  std::vector<double> states(1000, 0.5);
  std::vector<std::uint8_t> expected(states.size(), 1);
  for (std::size_t i = 0; i < states.size(); i += 3)
  {
    states[i] = 3.5;
    expected[i] = 0;
  }
  EXPECT_EQ(checker.check(states.data(), states.size()).valid, expected);
}

TEST_F(BatchCheckerTest, NamesTheBodiesThatCollideAndTheRevision)
{
  BatchChecker checker(scene_, with(Traversal::WorkQueue));
  const BatchResult hit = checker.check(touching_.data(), 1);
  ASSERT_EQ(hit.valid, std::vector<std::uint8_t>{0});
  EXPECT_EQ(scene_->bodyName(hit.colliding[0][0]), "lower");
  EXPECT_EQ(scene_->bodyName(hit.colliding[0][1]), "post");
  EXPECT_EQ(hit.revision, 41U);
  EXPECT_EQ(checker.check(free_.data(), 1).valid, std::vector<std::uint8_t>{1});
}

TEST_F(BatchCheckerTest, AnswersABatchOfHundredsOfThousandsOfStatesInItsOrder)
{
  BatchCheckerOptions options;
  BatchChecker checker(scene_, options);
  constexpr std::size_t kStates = 600'000;
  std::vector<double> states;
  for (std::size_t i = 0; i < kStates; ++i)
  {
    const std::vector<double>& state = i % 7 == 0 || i % 11 == 3 ? touching_ : free_;
    states.insert(states.end(), state.begin(), state.end());
  }
  const BatchResult result = checker.check(states.data(), kStates);
  ASSERT_EQ(result.valid.size(), kStates);
  ASSERT_EQ(result.colliding.size(), kStates);
  EXPECT_EQ(result.revision, 41U);
  for (std::size_t i = 0; i < kStates; ++i)
    ASSERT_EQ(result.valid[i] == 0, i % 7 == 0 || i % 11 == 3) << "state " << i;
}

TEST_F(BatchCheckerTest, ChecksNoStatesAtAll)
{
  BatchChecker checker(scene_, with(Traversal::WorkQueue));
  EXPECT_TRUE(checker.check(nullptr, 0).valid.empty());
}

/// In the touching state, the root boxes of a link and the post overlap. A call counts each of its states, however it
/// is split into parts.
TEST_F(BatchCheckerTest, CountsWhatTheGpuLookedAt)
{
  BatchChecker checker(scene_, with(Traversal::WorkQueue, 2));
  checker.check(touching_.data(), 1);
  const GpuWork one = checker.lastWork();
  EXPECT_EQ(one.states, 1U);
  EXPECT_GE(one.root_pairs, 1U);
  EXPECT_GE(one.candidates, one.root_pairs);
  std::vector<double> five;
  for (int i = 0; i < 5; ++i)
    five.insert(five.end(), touching_.begin(), touching_.end());
  checker.check(five.data(), 5);
  EXPECT_EQ(checker.lastWork().states, 5U);
  EXPECT_EQ(checker.lastWork().candidates, 5 * one.candidates);
  checker.check(nullptr, 0);
  EXPECT_EQ(checker.lastWork().states, 0U);

  BatchChecker together(scene_);
  together.check(touching_.data(), 1);
  EXPECT_EQ(together.lastWork().states, 0U);
}

TEST_F(BatchCheckerTest, RefusesValuesThatAreNotFiniteAndUnknownGroups)
{
  BatchChecker checker(scene_, with(Traversal::WorkQueue));
  for (const double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL})
  {
    const std::vector<double> state = {0.0, wrong};
    EXPECT_THROW(checker.check(state.data(), 1), Error);
  }
  EXPECT_THROW(checker.check(free_.data(), 1, "no such group"), Error);
  EXPECT_EQ(checker.check(touching_.data(), 1).valid, std::vector<std::uint8_t>{0});
}

TEST_F(BatchCheckerTest, RestrictsAGroupToPairsWithALinkThatItMoves)
{
  // The upper arm collides with the table. The pairs of the wrist's links do not collide.
  auto made = std::make_shared<PlanningScene>(*scene_);
  made->objects = {{"table", Eigen::Isometry3d(Eigen::Translation3d(0.3, 0.0, 0.2)), {{Box{{0.1, 0.1, 0.1}}}}}};
  for (const Traversal traversal : {Traversal::BreadthFirst, Traversal::WorkQueue})
  {
    BatchChecker checker(made, with(traversal));
    EXPECT_EQ(checker.check(free_.data(), 1).valid, std::vector<std::uint8_t>{0});
    EXPECT_EQ(checker.check(free_.data(), 1, "wrist").valid, std::vector<std::uint8_t>{1});
    EXPECT_EQ(checker.check(free_.data(), 1).valid, std::vector<std::uint8_t>{0});
    EXPECT_LT(checker.report("wrist").world_pairs, checker.report().world_pairs);
  }
}

TEST_F(BatchCheckerTest, TakesAnotherSceneAndKeepsTheOldOneWhenItCannot)
{
  BatchChecker checker(scene_, with(Traversal::WorkQueue));
  auto moved = std::make_shared<PlanningScene>(*scene_);
  moved->objects[0].pose = Eigen::Isometry3d(Eigen::Translation3d(0.67, -0.2, 0.2));
  moved->revision = 42;
  checker.setScene(moved);
  EXPECT_EQ(checker.check(touching_.data(), 1).valid, std::vector<std::uint8_t>{1});
  EXPECT_EQ(checker.check(free_.data(), 1).revision, 42U);

  auto too_far = std::make_shared<Mesh>();
  too_far->name = "too_far";
  too_far->vertices = {{0, 0, 0}, {1e30, 0, 0}, {0, 1, 0}};
  too_far->triangles = {{0, 1, 2}};
  auto broken = std::make_shared<PlanningScene>(*moved);
  broken->objects.push_back({"far", Eigen::Isometry3d::Identity(), {{std::shared_ptr<const Mesh>(too_far)}}});
  broken->revision = 43;
  EXPECT_THROW(checker.setScene(broken), Error);
  const BatchResult after = checker.check(free_.data(), 1);
  EXPECT_EQ(after.valid, std::vector<std::uint8_t>{0});
  EXPECT_EQ(after.revision, 42U);
}

TEST_F(BatchCheckerTest, RefusesASceneThatIsNotThere)
{
  BatchChecker checker(scene_, with(Traversal::WorkQueue));
  EXPECT_THROW(checker.setScene(nullptr), Error);
  EXPECT_EQ(checker.check(free_.data(), 1).revision, 41U);
}

TEST_F(BatchCheckerTest, SceneWithoutObjectsIsCheckedAgainstTheRobotAlone)
{
  auto empty = std::make_shared<PlanningScene>(*scene_);
  empty->objects.clear();
  BatchChecker checker(empty, with(Traversal::BreadthFirst));
  EXPECT_EQ(checker.check(touching_.data(), 1).valid, std::vector<std::uint8_t>{1});
}

TEST_F(BatchCheckerTest, AgreesWithTheCpuAtALatticeOfStates)
{
  std::vector<double> states;
  for (int shoulder = -30; shoulder <= 30; ++shoulder)
    for (int elbow = -31; elbow <= 31; ++elbow)
      states.insert(states.end(), {0.1 * shoulder, 0.1 * elbow});
  const std::size_t count = states.size() / 2;
  const std::vector<std::uint8_t> expected = CpuChecker(scene_).check(states.data(), count).valid;
  EXPECT_GT(std::count(expected.begin(), expected.end(), 0), 50);
  for (const Traversal traversal : {Traversal::BreadthFirst, Traversal::WorkQueue})
    EXPECT_EQ(BatchChecker(scene_, with(traversal)).check(states.data(), count).valid, expected);
}

TEST_F(BatchCheckerTest, ADriverThatPlacesLinksElsewhereIsReportedAndAnswersAreRightAllTheSame)
{
  ShaderFolder folder;
  folder.replace("problem/kinematics.glsl", "1.0lf / 6.0lf", "1.0lf / 7.0lf");  // a term of the sine
  BatchCheckerOptions options = with(Traversal::WorkQueue);
  options.shader_folder = folder.path();
  BatchChecker checker(scene_, options);
  EXPECT_NE(checker.deviceWarning().find("forward kinematics"), std::string::npos) << checker.deviceWarning();
  std::mt19937_64 generator(kSeed);
  constexpr std::size_t kStates = 2000;
  std::vector<double> states(kStates * 2);
  for (std::size_t i = 0; i < kStates; ++i)
    scene_->robot->randomState(generator, &states[2 * i]);
  EXPECT_EQ(checker.check(states.data(), kStates).valid, CpuChecker(scene_).check(states.data(), kStates).valid)
      << "seed " << kSeed;
  EXPECT_EQ(BatchChecker(scene_, with(Traversal::WorkQueue)).deviceWarning(), "");
}

TEST_F(BatchCheckerTest, RefusesOptionsThatMakeNoSense)
{
  EXPECT_THROW(BatchChecker(scene_, with(Traversal::WorkQueue, 0)), Error);
  BatchCheckerOptions options;
  options.device = "no such device";
  EXPECT_THROW(BatchChecker(scene_, options), Error);
  options = with(Traversal::WorkQueue);
  options.shader_folder = "/no/such/folder";
  EXPECT_THROW(BatchChecker(scene_, options), Error);
  EXPECT_THROW(traversalFromName("depth_first"), Error);
}

/// Lets the checker's device use proofs of `scene`, which a background thread loads or makes.
void useProofs(BatchChecker& checker, const TestScene& test, const std::shared_ptr<const PlanningScene>& scene)
{
  constexpr std::size_t kCount = 2'000;
  const std::vector<double> states = test.randomStates(kStatesBeforeProofs + 1, kSeed);
  BatchCheckerOptions options = with(Traversal::WorkQueue);
  options.reductions.proofs = false;
  BatchChecker unproven(scene, options);
  unproven.check(states.data(), kCount);
  ASSERT_GT(unproven.lastWork().traversed, 0u);
  checker.check(states.data(), kStatesBeforeProofs + 1);
  checker.check(states.data(), kCount);  // requests the proofs
  waitForProofs();
  checker.check(states.data(), kCount);
  ASSERT_LT(2 * checker.lastWork().traversed, unproven.lastWork().traversed) << checker.deviceWarning();
}

/// Expects the verdicts of the exact checker for random states.
void expectExact(BatchChecker& checker, const TestScene& test, const std::shared_ptr<const PlanningScene>& scene,
                 const std::string& group, std::uint64_t seed)
{
  constexpr std::size_t kCount = 4000;
  const std::vector<double> states = test.randomStates(kCount, seed);
  CheckerOptions exact;
  exact.reductions.proofs = false;
  const std::vector<std::uint8_t> expected = CpuChecker(scene, exact).check(states.data(), kCount, group).valid;
  EXPECT_EQ(checker.check(states.data(), kCount, group).valid, expected);
  EXPECT_GT(std::count(expected.begin(), expected.end(), 1), 0);
  EXPECT_GT(std::count(expected.begin(), expected.end(), 0), 0);
}

TEST(ProofsOnTheDevice, AreForgottenWithTheirScene)
{
  const TestScene& test = testScene("arm_boxes");
  BatchChecker checker(test.scene, with(Traversal::WorkQueue));
  useProofs(checker, test, test.scene);
  expectExact(checker, test, test.scene, "", kSeed + 1);
  for (const auto& group : test.scene->robot->groups())
    expectExact(checker, test, test.scene, group.name, kSeed + 2);

  auto carrying = std::make_shared<PlanningScene>(*test.scene);
  const int tip = static_cast<int>(test.scene->robot->links().size()) - 1;
  carrying->attached.push_back({{"load",
                                 Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.1, 0.1)),
                                 {{Sphere{0.1}, Eigen::Isometry3d::Identity()}},
                                 0.0},
                                tip,
                                {tip, tip - 1}});
  checker.setScene(carrying);
  expectExact(checker, test, carrying, "", kSeed + 3);

  auto padded = std::make_shared<PlanningScene>(*test.scene);
  padded->link_padding.assign(test.scene->robot->links().size(), 0.03);
  checker.setScene(padded);
  expectExact(checker, test, padded, "", kSeed + 4);
  useProofs(checker, test, padded);
  expectExact(checker, test, padded, "", kSeed + 5);

  const std::shared_ptr<PlanningScene> balls = slidingBalls();
  const std::vector<double> limits(balls->robot->variables().size(), kSlide);
  const TestScene other{"sliding_balls", balls, std::vector<double>(limits.size(), -kSlide), limits};
  checker.setScene(balls);
  expectExact(checker, other, balls, "", kSeed + 6);
}

using SeveralDevices = OnSoftwareDevice;

TEST_F(SeveralDevices, AnswerLikeOne)
{
  const TestScene& test = testScene("arm_boxes");
  constexpr std::size_t kCount = 40'000;
  const std::vector<double> states = test.randomStates(kCount, 3);
  BatchCheckerOptions options;
  options.device = "software+software";
  options.device_only = true;
  const auto two = openChecker(test.scene, options, [](const std::string&) {});
  EXPECT_NE(two->deviceName().find(" + "), std::string::npos);
  EXPECT_EQ(two->check(states.data(), kCount).valid, CpuChecker(test.scene).check(states.data(), kCount).valid);
  options.device = "software+no such device";
  EXPECT_NE(errorOf([&] { openChecker(test.scene, options, [](const std::string&) {}); }).find("no such device"),
            std::string::npos);
}
}  // namespace
}  // namespace gpu_planning_scene::core
