// The distances of bodies are the oracle's to a micrometre, no pair in the range is missing, the points and the normal
// belong to the distance, and the gradient is the oracle's slope.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "collision/contacts/padded_scene.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/state_inspector.h"
#include "support/distance_truth.h"
#include "support/seed.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
class Distances : public testing::TestWithParam<const char*>
{
 protected:
  void SetUp() override
  {
    if (const std::string missing = missingFor(GetParam()); !missing.empty())
      GTEST_SKIP() << "needs " << missing;
    test_ = &testScene(GetParam());
    scene_ = std::make_shared<const PlanningScene>(paddedScene(*test_));
    inspector_ = std::make_unique<StateInspector>(scene_);
    truth_ = std::make_unique<DistanceTruth>(scene_, "");
    states_ = test_->randomStates(kCount, kSeed);
  }

  const double* state(std::size_t i) const { return &states_[i * scene_->robot->variables().size()]; }

  static constexpr std::size_t kCount = 6;
  static constexpr double kRange = 0.4;  // metres
  const TestScene* test_ = nullptr;
  std::shared_ptr<const PlanningScene> scene_;
  std::unique_ptr<StateInspector> inspector_;
  std::unique_ptr<DistanceTruth> truth_;
  std::vector<double> states_;
};

TEST_P(Distances, OfAllPairsInTheRangeAreTheOracles)
{
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  const BodyDistances found = inspector_->distances(states_.data(), kCount, "", {kRange, false, true});
  ASSERT_EQ(found.first.size(), kCount + 1);
  DistanceFaults faults;
  for (std::size_t i = 0; i < kCount; ++i)
    faults += truth_->compareAllPairs(state(i), found, i, kRange);
  EXPECT_GT(faults.compared, kCount);
  EXPECT_EQ(faults.missing, 0u);
  EXPECT_EQ(faults.invented, 0u);
  EXPECT_LT(faults.distance_error, 1.1e-6);
  EXPECT_LT(faults.point_error, 4e-6);
  EXPECT_GT(faults.colliding, 0u) << "the test needs pairs that collide";
}

TEST_P(Distances, OfEachBodyAreThoseOfItsNearestPair)
{
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  const BodyDistances all = inspector_->distances(states_.data(), kCount, "", {10.0, false, false});
  const BodyDistances nearest = inspector_->distances(states_.data(), kCount, "", {10.0, true, false});
  EXPECT_TRUE(nearest.gradients.empty());
  for (std::size_t i = 0; i < kCount; ++i)
  {
    std::map<std::int32_t, double> least;
    for (std::size_t k = all.first[i]; k < all.first[i + 1]; ++k)
      for (const std::int32_t body : all.pairs[k].bodies)
        if (truth_->isOfRobot(body))
        {
          double& known = least.emplace(body, all.pairs[k].distance).first->second;
          known = std::min(known, all.pairs[k].distance);
        }
    ASSERT_EQ(nearest.first[i + 1] - nearest.first[i], least.size());
    for (std::size_t k = nearest.first[i]; k < nearest.first[i + 1]; ++k)
    {
      ASSERT_EQ(least.count(nearest.pairs[k].bodies[0]), 1u);
      EXPECT_NEAR(nearest.pairs[k].distance, least[nearest.pairs[k].bodies[0]], 1.1e-6);
    }
  }
}

TEST_P(Distances, HaveTheOraclesSlopeAsGradient)
{
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  const BodyDistances found = inspector_->distances(states_.data(), kCount, "", {kRange, false, true});
  const std::size_t width = scene_->robot->variables().size();
  ASSERT_EQ(found.gradients.size(), found.pairs.size() * width);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < kCount; ++i)
    for (std::size_t k = found.first[i], of_state = 0; k < found.first[i + 1] && of_state == 0; ++k)
    {
      if (found.pairs[k].distance <= 0.0)
        continue;
      ++of_state;
      ++compared;
      EXPECT_LT(truth_->gradientError(state(i), found.pairs[k], &found.gradients[k * width]), 1e-3)
          << i << " " << scene_->bodyName(found.pairs[k].bodies[0]) << " "
          << scene_->bodyName(found.pairs[k].bodies[1]);
    }
  EXPECT_GT(compared, 1u);
}

TEST_P(Distances, InCollisionKnowALengthThatDoesNotSeparateTheBodies)
{
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  const BodyDistances found = inspector_->distances(states_.data(), kCount, "", {kRange, false, false});
  std::size_t known = 0;
  for (std::size_t i = 0; i < kCount; ++i)
    for (std::size_t k = found.first[i]; k < found.first[i + 1]; ++k)
    {
      const BodyDistance& pair = found.pairs[k];
      EXPECT_EQ(pair.collides, pair.distance < 0.0);
      if (!pair.collides)
        continue;
      EXPECT_GE(pair.depth_at_least, 0.0);
      EXPECT_LE(pair.depth_at_least, -pair.distance);
      known += pair.depth_at_least > 0.0 ? 1 : 0;
      EXPECT_TRUE(truth_->collidesAfter(state(i), pair, 0.999 * pair.depth_at_least, kSeed));
    }
  if (GetParam() != std::string("arm_shelf"))
    EXPECT_GT(known, 0u);
}

TEST_P(Distances, WithoutDepthsAreZeroInCollision)
{
  DistanceQuery query{kRange, false, true, false};
  const BodyDistances found = inspector_->distances(states_.data(), kCount, "", query);
  query.signed_distance = true;
  const BodyDistances with_depths = inspector_->distances(states_.data(), kCount, "", query);
  ASSERT_EQ(found.pairs.size(), with_depths.pairs.size());
  for (std::size_t k = 0; k < found.pairs.size(); ++k)
  {
    EXPECT_EQ(found.pairs[k].distance, std::max(0.0, with_depths.pairs[k].distance));
    EXPECT_EQ(found.pairs[k].collides, with_depths.pairs[k].collides);
    EXPECT_EQ(found.pairs[k].normal.hasNaN(), found.pairs[k].collides);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Distances, testing::Values("arm_shelf", "arm_driven", "kr5_boxes"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(DistanceQueries, RefuseARangeThatIsNotAboveZero)
{
  const auto scene = std::make_shared<const PlanningScene>(*testScene("arm_shelf").scene);
  const StateInspector inspector(scene);
  const std::vector<double> state = scene->robot->defaultState();
  EXPECT_THROW(inspector.distances(state.data(), 1, "", {0.0, false, false}), Error);
  EXPECT_THROW(inspector.distances(state.data(), 1, "", {std::nan(""), false, false}), Error);
  EXPECT_EQ(inspector.distances(state.data(), 0, "", {}).first.size(), 1u);
}
}  // namespace
}  // namespace gpu_planning_scene::core
