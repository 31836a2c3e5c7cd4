// With a tolerance, what collides is still found, and nothing is called colliding that is further apart than that.
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "collision/state_rows.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/mesh_pair_checker.h"
#include "oracle/problem_oracle.h"
#include "support/carrying_scene.h"

namespace gpu_planning_scene
{
namespace
{
constexpr std::uint64_t kSeed = 23;
constexpr std::size_t kStates = 800;
constexpr std::size_t kMostMeasured = 5;  // by the oracle, which takes its time

CheckerOptions withTolerance(double tolerance)
{
  CheckerOptions options;
  options.tolerance = tolerance;
  return options;
}

class ToleranceIn : public testing::TestWithParam<const char*>
{
};

TEST_P(ToleranceIn, FindsAllCollisionsAndAddsOnlyWhatIsWithinIt)
{
  const std::string name = GetParam();
  if (const std::string missing = missingFor(name == "carrying" ? "ur5_table_pick" : name); !missing.empty())
    GTEST_SKIP() << "there is no " << missing;
  const TestScene scene = name == "carrying" ? carryingScene() : testScene(name);
  const RobotModel& robot = *scene.scene->robot;
  const std::vector<double> states = scene.randomStates(kStates, kSeed);
  const oracle::ProblemOracle oracle(std::make_shared<const CollisionProblem>(makeProblem(*scene.scene, "", nullptr)));
  const std::vector<std::uint8_t> exact = CpuChecker(scene.scene).check(states.data(), kStates).valid;
  std::vector<std::uint8_t> before = exact;
  std::size_t added = 0;
  for (const double tolerance : {0.001, 0.01, 0.05})
  {
    const std::vector<std::uint8_t> valid =
        CpuChecker(scene.scene, withTolerance(tolerance)).check(states.data(), kStates).valid;
    std::vector<std::size_t> measured;
    for (std::size_t i = 0; i < kStates; ++i)
    {
      EXPECT_LE(valid[i], before[i]) << "state " << i << " is free at " << tolerance << ", not at less, seed " << kSeed;
      if (exact[i] && !valid[i] && measured.size() < kMostMeasured)
        measured.push_back(i);
    }
    std::vector<double> clearances(measured.size());
    forChunks(measured.size(), 1,
              [&](std::size_t begin, std::size_t)
              {
                const double* state = &states[measured[begin] * robot.variables().size()];
                clearances[begin] = oracle.clearance(oracle::linkPoses(robot, state), 2.0 * tolerance);
              });
    for (std::size_t i = 0; i < measured.size(); ++i)
      EXPECT_LE(clearances[i], tolerance) << "state " << measured[i] << ", seed " << kSeed;
    added += measured.size();
    before = valid;
  }
  std::cout << "seed " << kSeed << ": " << added << " states called colliding that are free" << std::endl;
  EXPECT_GT(added, 0U);
}
INSTANTIATE_TEST_SUITE_P(Scenes, ToleranceIn, testing::Values("kr5", "ur5_cage", "carrying"));

TEST(Tolerance, IsRefusedIfNegativeOrNotFinite)
{
  const auto robot = RobotModel::fromXml(
      "<robot name='r'><link name='l'><collision><geometry><sphere radius='1'/></geometry></collision></link></robot>",
      "", {});
  const auto scene = std::make_shared<const PlanningScene>(robot);
  for (const double tolerance : {-1e-9, -HUGE_VAL, HUGE_VAL, std::nan("")})
  {
    EXPECT_THROW(CpuChecker(scene, withTolerance(tolerance)), Error);
    BatchCheckerOptions options;
    options.tolerance = tolerance;
    EXPECT_THROW(BatchChecker(scene, options), Error);
    EXPECT_THROW(MeshPairChecker(Sphere{1.0}, Sphere{1.0}, options), Error);
  }
}
}  // namespace
}  // namespace gpu_planning_scene
