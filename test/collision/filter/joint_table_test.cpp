// The cells of joint tables hold for each state in them.

#include <random>

#include <gtest/gtest.h>

#include "collision/bounds/problem_maker.h"
#include "collision/exact/cpu_shape_pair.h"
#include "collision/filter/joint_table.h"
#include "collision/filter/moving_pair.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint64_t kSeed = 37;

class JointTables : public testing::TestWithParam<const char*>
{
};

TEST_P(JointTables, HoldForRandomStatesOfTheirCells)
{
  if (const std::string missing = missingFor(GetParam()); !missing.empty())
    GTEST_SKIP() << "there is no " << missing;
  const PlanningScene& scene = *testScene(GetParam()).scene;
  const RobotModel& robot = *scene.robot;
  const auto problem = std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr));
  const auto forest = std::make_shared<const CpuForest>(*problem);
  const CpuShapePair exact(forest);
  CpuShapePair::Scratch scratch;
  std::mt19937_64 generator(kSeed);
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  std::size_t tables = 0;
  std::map<Proof, std::size_t> cells;
  for (const auto& [first, second] : problem->self_pairs)
  {
    const ShapeInstance& a = problem->robot[first];
    const ShapeInstance& b = problem->robot[second];
    const BallCover cover_a = coverOf(forest->tree(a.tree), problem->tessellations[a.tree].sagitta);
    const BallCover cover_b = coverOf(forest->tree(b.tree), problem->tessellations[b.tree].sagitta);
    const auto table =
        makeJointTable(robot, {&a, &forest->tree(a.tree), &cover_a, problem->tessellations[a.tree].sagitta},
                       {&b, &forest->tree(b.tree), &cover_b, problem->tessellations[b.tree].sagitta}, exact);
    if (!table || tables == 4)
      continue;
    ++tables;
    for (int i = 0; i < 5000; ++i)
    {
      std::vector<double> state(robot.variables().size());
      robot.randomState(generator, state.data());
      std::size_t cell = 0;
      for (const TableVariable& variable : table->variables)
      {
        const auto place = static_cast<int>(generator() % static_cast<std::uint64_t>(variable.cells));
        // Corners of cells are as likely as their inside.
        const double share = generator() % 2 == 0 ? static_cast<double>(generator() % 2)
                                                  : std::uniform_real_distribution<double>(0.0, 1.0)(generator);
        state[static_cast<std::size_t>(variable.variable)] = variable.lower + variable.cell_width * (place + share);
        cell = cell * static_cast<std::size_t>(variable.cells) + static_cast<std::size_t>(place);
      }
      const Proof proof = table->cells[cell];
      ++cells[proof];
      if (proof == Proof::None)
        continue;
      robot.linkPoses(state.data(), poses.data());
      const auto pose_of = [&](const ShapeInstance& instance)
      { return poses[static_cast<std::size_t>(instance.link)] * instance.pose; };
      ASSERT_EQ(exact.collide(a.tree, pose_of(a), b.tree, pose_of(b), 0.0, scratch), proof == Proof::Colliding)
          << scene.bodyName(a.body) << " - " << scene.bodyName(b.body) << ", seed " << kSeed;
    }
  }
  std::cout << tables << " tables; apart " << cells[Proof::Apart] << ", colliding " << cells[Proof::Colliding]
            << ", none " << cells[Proof::None] << ", seed " << kSeed << std::endl;
  EXPECT_GT(tables, 0u);
  EXPECT_GT(cells[Proof::Apart], 1000u);
}
INSTANTIATE_TEST_SUITE_P(Scenes, JointTables, testing::Values("kr5", "ur5_cage", "arm_boxes"));
}  // namespace
}  // namespace gpu_planning_scene::core
