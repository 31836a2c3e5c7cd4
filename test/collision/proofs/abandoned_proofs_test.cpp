// The proofs of large meshes that move closely past each other would take minutes. They are cut short, nobody waits for
// them at the end, and those of other robots do not wait for them.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "base/seconds_since.h"
#include "collision/bounds/problem_maker.h"
#include "collision/exact/forest_cache.h"
#include "collision/proofs/proof_scene.h"
#include "collision/proofs/proof_worker.h"
#include "support/obstacles.h"

namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;

// A busy machine needs longer than the processor time of the work, and the proofs have a low priority.
constexpr double kSoon = 2.0;  // seconds

/// A sphere with a small hole: an open mesh.
std::shared_ptr<const Mesh> shell(double radius, std::size_t triangles)
{
  const auto closed =
      closedSurface("shell", triangles, 2.0,
                    [radius](double along, double angle) -> Eigen::Vector3d
                    {
                      const double across = radius * std::sin(M_PI * along);
                      return {across * std::cos(angle), across * std::sin(angle), radius * std::cos(M_PI * along)};
                    });
  auto open = std::make_shared<Mesh>(*closed);
  open->triangles.resize(open->triangles.size() - 10);
  open->solid = SolidRule::Surface;  // else the small hole would be filled
  return open;
}

/// Two concentric shells with a gap of 1 cm. Two continuous joints turn the inner one within the outer one.
std::shared_ptr<const RobotModel> shellRobot(std::size_t triangles)
{
  RobotModelOptions options;
  options.meshes.find = [](const std::string& uri) { return uri; };
  options.meshes.read = [triangles](const std::string& path, const Eigen::Vector3d&)
  { return shell(path == "outer" ? 0.3 : 0.29, triangles); };
  return RobotModel::fromXml(R"(<robot name="shells">
      <link name="outside"><collision><geometry><mesh filename="outer"/></geometry></collision></link>
      <link name="ring"/>
      <link name="inside"><collision><geometry><mesh filename="inner"/></geometry></collision></link>
      <joint name="turn" type="continuous"><parent link="outside"/><child link="ring"/><axis xyz="0 0 1"/></joint>
      <joint name="tilt" type="continuous"><parent link="ring"/><child link="inside"/><axis xyz="0 1 0"/></joint>
      </robot>)",
                             "", options);
}

/// What a prover needs to know of a robot without a world.
struct ToProve
{
  explicit ToProve(const PlanningScene& scene)
    : robot(scene.robot), problem(std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr)))
  {
    trees.exactCheckerOf(problem);
  }

  std::shared_ptr<ProofJob> inBackground() const { return proveInBackground(robot, problem, trees.forest()); }

  std::shared_ptr<const RobotModel> robot;
  std::shared_ptr<const CollisionProblem> problem;
  ForestCache trees;
};

std::shared_ptr<const RobotProofs> waitForCovers(const ProofJob& job)
{
  const Clock::time_point start = Clock::now();
  while (!job.proofs() && secondsSince(start) < 60.0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return job.proofs();
}

class AbandonedProofs : public testing::Test
{
 public:
  AbandonedProofs() { setenv("GPU_PLANNING_SCENE_PROOF_CACHE", "off", 1); }
};

TEST_F(AbandonedProofs, EndSoonAmongBallsAndTables)
{
  const ToProve shells{PlanningScene(shellRobot(50000))};
  std::shared_ptr<ProofJob> job = shells.inBackground();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  Clock::time_point start = Clock::now();
  job.reset();
  waitForProofs();
  EXPECT_LT(secondsSince(start), kSoon) << "while balls are made";

  job = shells.inBackground();
  const auto covers = waitForCovers(*job);
  ASSERT_TRUE(covers);
  EXPECT_FALSE(covers->has_all_tables);
  start = Clock::now();
  job.reset();
  waitForProofs();
  EXPECT_LT(secondsSince(start), kSoon) << "while a table is made";
}

TEST_F(AbandonedProofs, DoNotDelayTheEndOfTheProcess)
{
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        static Clock::time_point start;
        // It is registered before the worker is made, so it is called after the worker's end.
        std::atexit([] { std::_Exit(secondsSince(start) < kSoon ? EXIT_SUCCESS : EXIT_FAILURE); });
        static std::shared_ptr<ProofJob> job;  // somebody still needs the proofs
        job = ToProve(PlanningScene(shellRobot(20000))).inBackground();
        if (!waitForCovers(*job) || job->proofs()->has_all_tables)
          std::_Exit(EXIT_FAILURE);
        start = Clock::now();
        std::exit(EXIT_SUCCESS);
      },
      testing::ExitedWithCode(EXIT_SUCCESS), "");
}

/// The first self pair of a robot, with all that its joint table needs.
class TablePair
{
 public:
  explicit TablePair(const ToProve& robot, bool has_points = true)
    : robot_(robot),
      a_(prepared(robot.problem->self_pairs.at(0)[0], has_points)),
      b_(prepared(robot.problem->self_pairs.at(0)[1], has_points))
  {
  }

  std::optional<JointTable> table(const Stopped& stopped, std::uint64_t most_steps) const
  {
    return makeJointTable(*robot_.robot, instanceOf(a_), instanceOf(b_), CpuShapePair(forest_), stopped, most_steps);
  }
  std::size_t points() const { return a_.depth.points().size() + b_.depth.points().size(); }

 private:
  struct Prepared
  {
    const ShapeInstance* instance;
    BallCover cover;
    SolidDepth depth;
  };

  Prepared prepared(std::uint32_t number, bool has_points) const
  {
    const ShapeInstance& instance = robot_.problem->robot[number];
    const CpuTree& tree = forest_->tree(instance.tree);
    ShapeSamples samples = samplesOf(tree);
    BallCover cover = coverOf(tree, samples, 0.0);
    if (!has_points)
      samples.points.clear();
    return {&instance, std::move(cover), SolidDepth(samples, 0.0)};
  }
  TableInstance instanceOf(const Prepared& side) const
  {
    return {side.instance, &forest_->tree(side.instance->tree), &side.cover, &side.depth, 0.0};
  }

  const ToProve& robot_;
  const std::shared_ptr<const CpuForest> forest_ = robot_.trees.forest();
  Prepared a_;
  Prepared b_;
};

TEST_F(AbandonedProofs, ATableEndsAfterAFixedNumberOfSteps)
{
  const ToProve shells{PlanningScene(shellRobot(6000))};
  const TablePair pair(shells);
  std::uint64_t calls = 0;  // one in each box of joint values, in every 256 points, and in every 64 pairs of nodes
  const Stopped count = [&calls]
  {
    ++calls;
    return false;
  };
  const auto table = pair.table(count, 1'000'000);
  ASSERT_TRUE(table);
  EXPECT_GT(std::count(table->cells.begin(), table->cells.end(), Proof::None), 0);
  EXPECT_GT(calls, 1'000U);
  EXPECT_LT(calls, 80'000U) << "without a limit, there are 40 million";
}

/// On a machine whose cores are busy, the points of one box of joint values can take a second.
TEST_F(AbandonedProofs, ATableLooksForItsEndAmongThePointsOfABox)
{
  const ToProve shells{PlanningScene(shellRobot(6000))};
  const auto calls_of = [](const TablePair& pair)
  {
    std::size_t calls = 0;
    const Stopped count = [&calls]
    {
      ++calls;
      return false;
    };
    EXPECT_TRUE(pair.table(count, 1)) << "of one box with points, because its tests take more than one step";
    return calls;
  };
  const TablePair pair(shells);
  ASSERT_GT(pair.points(), 700U);
  EXPECT_GE(calls_of(pair), calls_of(TablePair(shells, false)) + 2) << "without points";
}

/// With each call, one more cover or table is made. Proofs are published only if they are other ones than before.
TEST_F(AbandonedProofs, WorkThatIsPausedGoesOn)
{
  const ToProve slider(*proofScene(sliderRobot()));
  std::size_t published = 0;
  const auto prove = [&](RobotProver& prover, RobotProofs& proofs, const Stopped& paused)
  {
    const RobotProofs before = proofs;
    return prover.prove(
        *slider.robot, *slider.problem, slider.trees.forest(), ProofCache(),
        [&](RobotProofs made)
        {
          EXPECT_FALSE(made.isSame(proofs));
          proofs = std::move(made);
          ++published;
        },
        {}, paused, before.covers.empty() ? nullptr : &before);
  };
  RobotProver at_once;
  RobotProofs expected;
  EXPECT_TRUE(prove(at_once, expected, {}));
  RobotProver in_turns;
  RobotProofs proofs;
  std::size_t turns = 1;
  published = 0;
  while (!prove(in_turns, proofs, [] { return true; }) && turns < 100)
  {
    EXPECT_FALSE(proofs.has_all_tables);
    ++turns;
  }
  EXPECT_GE(turns, slider.problem->robot.size());
  EXPECT_LE(published, turns) << "a turn makes one cover or one table";
  EXPECT_TRUE(prove(in_turns, proofs, {})) << "there is nothing more to make";
  EXPECT_LE(published, turns) << "and nothing new to publish";
  EXPECT_TRUE(proofs.has_all_tables);
  ASSERT_EQ(proofs.tables.size(), expected.tables.size());
  for (std::size_t i = 0; i < proofs.tables.size(); ++i)
  {
    ASSERT_EQ(proofs.tables[i] == nullptr, expected.tables[i] == nullptr);
    const bool has_table = proofs.tables[i] != nullptr;
    EXPECT_TRUE(!has_table || proofs.tables[i]->cells == expected.tables[i]->cells);
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
