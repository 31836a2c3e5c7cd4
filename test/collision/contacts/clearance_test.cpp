// The clearance is within a micrometre of the oracle's clearance and never exceeds it.

#include <cmath>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "collision/exact/pair_clearance.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/state_inspector.h"
#include "oracle/problem_oracle.h"
#include "support/obstacles.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint64_t kSeed = 23;

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
  PlanningScene scene() const
  {
    PlanningScene made = *test_.scene;
    const auto objects = generateObstacles({12, Eigen::Vector3d(0, 0, 0.5), 0.9, 1.5, 0.3}, 5);
    for (const WorldObject& object : objects)
    {
      made.objects.push_back(object);
      made.objects.back().id = "more " + std::to_string(made.objects.size());
      made.objects.back().padding = 0.004;
    }
    made.objects.push_back({"floor", Eigen::Isometry3d::Identity(), {{HalfSpace{Eigen::Vector3d::UnitZ(), -0.2}}}});
    made.link_padding.assign(made.robot->links().size(), 0.006);
    return made;
  }

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
