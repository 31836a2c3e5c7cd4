#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "collision/exact/cpu_shape_pair.h"
#include "collision/problem/collision_problem.h"
#include "collision/proofs/ball_cover.h"
#include "collision/proofs/proof.h"
#include "collision/proofs/solid_depth.h"
#include "collision/proofs/stopped.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// One variable of a joint table. Its range is cut into cells of equal width.
struct TableVariable
{
  int variable;
  bool wraps;  ///< the angle counts modulo 2 pi, and the range is [-pi, pi]
  double lower;
  double cell_width;  ///< radians or metres
  int cells;
};

/// The verdicts of a pair of robot instances whose relative pose depends on one or two variables, for boxes of these
/// variables (a precomputed map of the configuration space, as in Lozano-Perez, "Spatial planning: a configuration
/// space approach", 1983). A verdict holds for each state in its box. Immutable.
struct JointTable
{
  std::vector<TableVariable> variables;  ///< one or two
  std::vector<Proof> cells;              ///< row-major
};

/// A robot instance of a table, with the prepared data of its shape.
struct TableInstance
{
  const ShapeInstance* instance;
  const CpuTree* tree;
  const BallCover* cover;
  const SolidDepth* depth;
  double sagitta;  ///< see Tessellation
};

/// The steps after which the cells of a table that are still open stay without a proof. A step is a visit of two nodes;
/// a second has some millions. The tables of the robots of the benchmark need at most 15 million steps, and those of
/// large meshes that move closely past each other would need billions.
constexpr std::uint64_t kMostTableSteps = 20'000'000;

/// Makes the table of a self pair. No value if the pair depends on more than two variables, on a planar or floating
/// joint, or on a joint without limits that is not continuous. `pairs` decides whether two trees collide. Throws
/// ProofsStopped.
std::optional<JointTable> makeJointTable(const RobotModel& robot, const TableInstance& a, const TableInstance& b,
                                         const CpuShapePair& pairs, const Stopped& stopped = {},
                                         std::uint64_t most_steps = kMostTableSteps);
}  // namespace gpu_planning_scene::core
