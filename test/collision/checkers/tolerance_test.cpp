// With a tolerance, all collisions are still found, and a pair that is reported is at most the tolerance apart.
#include <cmath>
#include <iostream>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "base/parallel_for.h"
#include "collision/bounds/problem_maker.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/mesh_pair_checker.h"
#include "oracle/problem_oracle.h"
#include "support/carrying_scene.h"
#include "support/kept_trees.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kToleratedStates = repetitions(300, 800);
constexpr std::size_t kMaxMeasured = 5;  // by the oracle, which is slow

/// A checker with a tolerance. `method`: "cpu", "breadth_first" or "work_queue".
std::unique_ptr<StateChecker> checkerWith(double tolerance, const std::string& method,
                                          const std::shared_ptr<const PlanningScene>& scene)
{
  BatchCheckerOptions options;
  options.tolerance = tolerance;
  if (method == "cpu")
    return std::make_unique<CpuChecker>(scene, options);
  options.traversal = traversalFromName(method);
  options.device_only = true;
  return std::make_unique<BatchChecker>(scene, options);
}

/// The method's checker with a tolerance, for a scene. Each checker is made once per process, because compiling shaders
/// takes a while.
StateChecker& keptCheckerWith(double tolerance, const std::string& method,
                              const std::shared_ptr<const PlanningScene>& scene)
{
  static std::map<std::pair<double, std::string>, std::unique_ptr<StateChecker>> made;
  std::unique_ptr<StateChecker>& checker = made[{tolerance, method}];
  if (checker)
    checker->setScene(scene);
  else
    checker = checkerWith(tolerance, method, scene);
  return *checker;
}

/// A scene with the verdicts of the exact checker and with the oracle.
struct ExactScene
{
  explicit ExactScene(const TestScene& from)
    : scene(from.scene),
      states(from.randomStates(kToleratedStates, kSeed)),
      valid(CpuChecker(scene).check(states.data(), kToleratedStates).valid),
      oracle(std::make_shared<const CollisionProblem>(makeProblem(*scene, "", nullptr)))
  {
    keepTrees(*scene);
  }

  std::shared_ptr<const PlanningScene> scene;
  std::vector<double> states;
  std::vector<std::uint8_t> valid;
  oracle::ProblemOracle oracle;
};

/// The scene called `name`, which all methods share.
const ExactScene& exactScene(const std::string& name)
{
  static std::map<std::string, ExactScene> made;
  const auto known = made.find(name);
  if (known != made.end())
    return known->second;
  return made.try_emplace(name, name == "carrying" ? carryingScene() : testScene(name)).first->second;
}

const auto kMethods = testing::Values("cpu", "breadth_first", "work_queue");

class ToleranceIn : public testing::TestWithParam<std::tuple<const char*, const char*>>
{
};

TEST_P(ToleranceIn, FindsAllCollisionsAndAddsOnlyWhatIsWithinIt)
{
  const std::string name = std::get<0>(GetParam());
  const std::string method = std::get<1>(GetParam());
  if (const std::string missing = missingFor(name == "carrying" ? "ur5_table_pick" : name); !missing.empty())
    GTEST_SKIP() << "there is no " << missing;
  const ExactScene& exact = exactScene(name);
  const RobotModel& robot = *exact.scene->robot;
  std::vector<std::uint8_t> before = exact.valid;
  std::size_t added = 0;
  for (const double tolerance : {0.001, 0.01, 0.05})
  {
    const std::vector<std::uint8_t> valid =
        keptCheckerWith(tolerance, method, exact.scene).check(exact.states.data(), kToleratedStates).valid;
    std::vector<std::size_t> measured;
    for (std::size_t i = 0; i < kToleratedStates; ++i)
    {
      EXPECT_LE(valid[i], before[i]) << "state " << i << " is free at " << tolerance << ", not at less, seed " << kSeed;
      if (exact.valid[i] && !valid[i] && measured.size() < kMaxMeasured)
        measured.push_back(i);
    }
    std::vector<double> clearances(measured.size());
    parallelFor(measured.size(), 1,
                [&](std::size_t begin, std::size_t)
                {
                  const double* state = &exact.states[measured[begin] * robot.variables().size()];
                  clearances[begin] = exact.oracle.clearance(oracle::linkPoses(robot, state), 2.0 * tolerance);
                });
    for (std::size_t i = 0; i < measured.size(); ++i)
      EXPECT_LE(clearances[i], tolerance) << "state " << measured[i] << ", seed " << kSeed;
    added += measured.size();
    before = valid;
  }
  std::cout << "seed " << kSeed << ": " << added << " states called colliding that are free" << std::endl;
  EXPECT_GT(added, 0U);
}
INSTANTIATE_TEST_SUITE_P(Scenes, ToleranceIn,
                         testing::Combine(testing::Values("kr5", "ur5_cage", "carrying"), kMethods));

class ToleranceBy : public testing::TestWithParam<const char*>
{
};
INSTANTIATE_TEST_SUITE_P(Methods, ToleranceBy, kMethods);

/// Two ball meshes: one in the world, one that floats around it. Their gaps range from touching to more than the
/// required distance, in random directions and orientations.
TEST_P(ToleranceBy, CountsOnTopOfPaddingForMeshesFromAllSides)
{
  constexpr double kRadius = 0.2;
  auto scene = std::make_shared<PlanningScene>(
      RobotModel::fromXml("<robot name='r'><link name='root'/><link name='l'/><joint name='j' type='floating'>"
                          "<parent link='root'/><child link='l'/></joint></robot>",
                          "", {}));
  const std::shared_ptr<const Mesh> ball = tessellate(Sphere{kRadius}).mesh;
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  scene->objects = {{"moving", identity, {{ball}}}, {"ball", identity, {{ball}}, 0.03}};
  scene->attach("moving", "l", {}, scene->robot->defaultState().data());
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> gaps(0.0, 0.2);
  constexpr std::size_t kPoses = repetitions(500, 4000);
  std::vector<double> states;
  std::vector<double> gap;
  for (std::size_t i = 0; i < kPoses; ++i)
  {
    std::normal_distribution<double> normal;
    Eigen::Vector3d side(normal(generator), normal(generator), normal(generator));
    gap.push_back(gaps(generator));
    side *= (2.0 * kRadius + gap.back()) / side.norm();
    states.insert(states.end(), side.begin(), side.end());
    for (int k = 0; k < 4; ++k)
      states.push_back(normal(generator));
  }
  for (const double tolerance : {0.0, 0.005, 0.05})
  {
    const std::vector<std::uint8_t> valid =
        checkerWith(tolerance, GetParam(), scene)->check(states.data(), kPoses).valid;
    double farthest = 0.0;
    for (std::size_t i = 0; i < kPoses; ++i)
    {
      // Each mesh lies inside its ball, by up to 0.1 mm.
      EXPECT_TRUE(gap[i] > 0.0297 || valid[i] == 0) << gap[i] << ", seed " << kSeed;
      if (valid[i] == 0)
        farthest = std::max(farthest, gap[i]);
    }
    EXPECT_LE(farthest, 0.03 + tolerance) << "seed " << kSeed;
    std::cout << "tolerance " << tolerance << ": farthest " << farthest << std::endl;
  }
}

TEST(Tolerance, IsRefusedIfNegativeOrNotFinite)
{
  const auto robot = RobotModel::fromXml(
      "<robot name='r'><link name='l'><collision><geometry><sphere radius='1'/></geometry></collision></link></robot>",
      "", {});
  const auto scene = std::make_shared<const PlanningScene>(robot);
  for (const double tolerance : {-1e-9, -HUGE_VAL, HUGE_VAL, std::nan("")})
  {
    BatchCheckerOptions options;
    options.tolerance = tolerance;
    EXPECT_THROW(CpuChecker(scene, options), Error);
    EXPECT_THROW(BatchChecker(scene, options), Error);
    EXPECT_THROW(MeshPairChecker(Sphere{1.0}, Sphere{1.0}, options), Error);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
