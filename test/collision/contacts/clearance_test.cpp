// The clearance is within a micrometre of the oracle's clearance and never exceeds it.

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "collision/contacts/padded_scene.h"
#include "collision/exact/pair_clearance.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/state_inspector.h"
#include "oracle/problem_oracle.h"
#include "support/seed.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The problem with only its world pairs or only its self pairs.
std::shared_ptr<const CollisionProblem> partOf(const PlanningScene& scene, const std::string& group, bool world)
{
  CollisionProblem problem = makeProblem(scene, group, nullptr);
  if (world)
  {
    problem.self_pairs.clear();
  }
  else
  {
    problem.world_pairs.assign(problem.world_pairs.size(), 0);
    problem.half_space_pairs.assign(problem.half_space_pairs.size(), 0);
  }
  return std::make_shared<const CollisionProblem>(problem);
}

class ClearanceTest : public testing::Test
{
 protected:
  PlanningScene scene() const { return paddedScene(test_); }

  void expectTheOracles(const PlanningScene& scene, const std::string& group, std::size_t count)
  {
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    const oracle::ProblemOracle world(partOf(scene, group, true));
    const oracle::ProblemOracle self(partOf(scene, group, false));
    const StateInspector inspector(std::make_shared<const PlanningScene>(scene));
    const std::size_t width = scene.robot->variables().size();
    const std::vector<double> states = test_.randomStates(count, kSeed);
    std::size_t free = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      const double* state = &states[i * width];
      const auto poses = oracle::linkPoses(*scene.robot, state);
      const Clearance clearance = inspector.clearance(state, group);
      const double true_world = std::max(0.0, world.clearance(poses, 10.0));
      const double true_self = std::max(0.0, self.clearance(poses, 10.0));
      EXPECT_LE(clearance.world, true_world + 1e-9) << i;
      EXPECT_GE(clearance.world, true_world - 1.1e-6) << i;
      EXPECT_LE(clearance.self, true_self + 1e-9) << i;
      EXPECT_GE(clearance.self, true_self - 1.1e-6) << i;
      EXPECT_LT(clearance.nearest_world[0], clearance.nearest_world[1]);
      free += true_world > 0.0 && true_self > 0.0 ? 1 : 0;
    }
    EXPECT_GT(free, 0u);
    EXPECT_LT(free, count);
  }

  const TestScene& test_ = testScene("arm_shelf");
};

TEST_F(ClearanceTest, IsTheOraclesToAMicrometreAndNeverMore)
{
  expectTheOracles(scene(), "", 12);
}

TEST_F(ClearanceTest, OfAGroupIsOfThePairsThatItMoves)
{
  expectTheOracles(scene(), "arm", 12);
}

/// The problem of `scene` with only the pairs of these two bodies.
std::shared_ptr<const CollisionProblem> pairOf(const PlanningScene& scene, const BodyPair& bodies)
{
  CollisionProblem problem = makeProblem(scene, "", nullptr);
  const auto is_of_pair = [&](std::int32_t a, std::int32_t b) {
    return BodyPair{std::min(a, b), std::max(a, b)} == bodies;
  };
  std::vector<InstancePair> self_pairs;
  for (const auto& pair : problem.self_pairs)
    if (is_of_pair(problem.robot[pair[0]].body, problem.robot[pair[1]].body))
      self_pairs.push_back(pair);
  problem.self_pairs = self_pairs;
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
  {
    for (std::size_t k = 0; k < problem.world.size(); ++k)
      if (!is_of_pair(problem.robot[i].body, problem.world[k].body))
        problem.world_pairs[i * problem.world.size() + k] = 0;
    for (std::size_t k = 0; k < problem.half_spaces.size(); ++k)
      if (!is_of_pair(problem.robot[i].body, problem.half_spaces[k].body))
        problem.half_space_pairs[i * problem.half_spaces.size() + k] = 0;
  }
  return std::make_shared<const CollisionProblem>(problem);
}

TEST_F(ClearanceTest, HasANearestPairWithItsPointsAndInCollisionItsDepth)
{
  const auto made = std::make_shared<const PlanningScene>(scene());
  const StateInspector inspector(made);
  const std::size_t width = made->robot->variables().size();
  constexpr std::size_t kCount = 20;
  const std::vector<double> states = test_.randomStates(kCount, kSeed);
  const std::vector<NearestPairs> found = inspector.nearestPairs(states.data(), kCount, "");
  ASSERT_EQ(kCount, found.size());
  const auto objects = static_cast<std::int32_t>(made->robot->links().size());
  std::size_t free = 0;
  for (std::size_t i = 0; i < kCount; ++i)
  {
    const double* state = &states[i * width];
    const Clearance clearance = inspector.clearance(state, "");
    const auto poses = oracle::linkPoses(*made->robot, state);
    const std::vector<Contact> contacts = inspector.contacts(state, "", 1000, 1);
    for (const bool of_world : {true, false})
    {
      const NearestPair& pair = of_world ? found[i].world : found[i].self;
      const double expected = of_world ? clearance.world : clearance.self;
      EXPECT_EQ(of_world, pair.bodies[1] >= objects) << i;
      if (expected == 0.0)
      {
        const auto deepest =
            std::find_if(contacts.begin(), contacts.end(),
                         [&](const Contact& contact) { return (contact.bodies[1] >= objects) == of_world; });
        ASSERT_NE(contacts.end(), deepest);
        EXPECT_EQ(-deepest->depth, pair.distance);
        EXPECT_EQ(deepest->bodies, pair.bodies);
        EXPECT_EQ(deepest->point, pair.points[1]);
        continue;
      }
      ++free;
      EXPECT_EQ(expected, pair.distance);
      EXPECT_NEAR(oracle::ProblemOracle(pairOf(*made, pair.bodies)).clearance(poses, 10.0), pair.distance, 2e-6);
      double required = 0.0;
      if (of_world)
        required = 0.006 + (pair.bodies[1] < objects + static_cast<std::int32_t>(made->objects.size())
                                ? made->objects[static_cast<std::size_t>(pair.bodies[1] - objects)].padding
                                : 0.0);
      EXPECT_NEAR(pair.distance + required, (pair.points[1] - pair.points[0]).norm(), 4e-6) << i;
    }
  }
  EXPECT_GT(free, kCount / 4);
  EXPECT_LT(free, 2 * kCount);
}

TEST_F(ClearanceTest, IsInfiniteWhereNothingIsChecked)
{
  PlanningScene alone(test_.scene->robot);
  const StateInspector inspector(std::make_shared<const PlanningScene>(alone));
  const std::vector<double> state = alone.robot->defaultState();
  const Clearance clearance = inspector.clearance(state.data(), "");
  EXPECT_EQ(clearance.world, std::numeric_limits<double>::infinity());
  EXPECT_EQ(clearance.nearest_world, (BodyPair{-1, -1}));
}

TEST_F(ClearanceTest, IsZeroForABodyInsideAnother)
{
  PlanningScene scene(test_.scene->robot);
  // A shell around the whole robot: no surfaces meet.
  scene.objects.push_back({"shell", Eigen::Isometry3d::Identity(), {{tessellate(Box{{20, 20, 20}}).mesh}}});
  const StateInspector inspector(std::make_shared<const PlanningScene>(scene));
  const std::vector<double> state = scene.robot->defaultState();
  EXPECT_EQ(inspector.clearance(state.data(), "").world, 0.0);
}

TEST_F(ClearanceTest, IsFoundAlsoWhereDoublesHaveNoMicrometres)
{
  for (const double distance : {1e12, 1e30, 1e100})
  {
    const double found = bisectLeast(0.0, 2.0 * distance, [distance](double x) { return x >= distance; });
    EXPECT_LE(found, distance);
    EXPECT_GE(found, distance * (1.0 - 1e-12));
  }
}

TEST_F(ClearanceTest, NamesThePairThatIsNearest)
{
  PlanningScene scene(test_.scene->robot);
  scene.objects.push_back({"far", Eigen::Isometry3d(Eigen::Translation3d(50, 0, 0)), {{Sphere{1.0}}}});
  scene.objects.push_back({"near", Eigen::Isometry3d(Eigen::Translation3d(0, 30, 0)), {{Sphere{1.0}}}});
  const StateInspector inspector(std::make_shared<const PlanningScene>(scene));
  const std::vector<double> state = scene.robot->defaultState();
  const Clearance clearance = inspector.clearance(state.data(), "");
  EXPECT_EQ(scene.bodyName(clearance.nearest_world[1]), "near");
  EXPECT_GT(clearance.world, 20.0);
  EXPECT_LT(clearance.world, 30.0);
}
}  // namespace
}  // namespace gpu_planning_scene::core
