// The cells of joint tables hold for each state in them.

#include <random>

#include <gtest/gtest.h>

#include "collision/exact/cpu_shape_pair.h"
#include "collision/proofs/proven_scene.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
TEST_P(ProvenScenes, CellsOfJointTablesHoldInRandomStates)
{
  const ProvenScene& proven = *proven_;
  const PlanningScene& scene = *proven.scene.scene;
  const CpuShapePair exact(proven.forest.forest());
  CpuShapePair::Scratch scratch;
  std::mt19937_64 generator(kSeed);
  std::vector<Eigen::Isometry3d> poses(robot().links().size());
  std::size_t tables = 0;
  std::map<Proof, std::size_t> cells;
  for (std::size_t p = 0; p < proven.proofs->tables.size(); ++p)
  {
    const JointTable* table = proven.proofs->tables[p].get();
    if (!table)
      continue;
    const ShapeInstance& a = proven.problem->robot[proven.problem->self_pairs[p][0]];
    const ShapeInstance& b = proven.problem->robot[proven.problem->self_pairs[p][1]];
    ++tables;
    for (int i = 0; i < repetitions(1000, 20000); ++i)
    {
      std::vector<double> state(robot().variables().size());
      robot().randomState(generator, state.data());
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
      robot().linkPoses(state.data(), poses.data());
      const auto pose_of = [&](const ShapeInstance& instance)
      { return poses[static_cast<std::size_t>(instance.link)] * instance.pose; };
      ASSERT_EQ(exact.collide(a.tree, pose_of(a), b.tree, pose_of(b), 0.0, scratch), proof == Proof::Colliding)
          << scene.bodyName(a.body) << " - " << scene.bodyName(b.body) << ", seed " << kSeed;
    }
  }
  std::cout << tables << " tables; apart " << cells[Proof::Apart] << ", colliding " << cells[Proof::Colliding]
            << ", none " << cells[Proof::None] << ", seed " << kSeed << std::endl;
  if (GetParam() == std::string("arm_boxes"))
  {
    EXPECT_EQ(tables, 0u) << "its pairs depend on more joints";
    return;
  }
  EXPECT_GT(tables, 0u);
  EXPECT_GT(cells[Proof::Apart], 1000u);
  EXPECT_GT(cells[Proof::Colliding], 10u);
}
}  // namespace

#ifdef GPS_SOAK
INSTANTIATE_TEST_SUITE_P(Filter, ProvenScenes, testing::Values("kr5", "kr5_crowded", "ur5_cage", "wam", "arm_boxes"));
#else
INSTANTIATE_TEST_SUITE_P(Filter, ProvenScenes, testing::Values("kr5", "arm_boxes"));
#endif
}  // namespace gpu_planning_scene::core
