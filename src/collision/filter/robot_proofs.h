#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "collision/exact/cpu_forest.h"
#include "collision/filter/ball_cover.h"
#include "collision/filter/joint_table.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The proofs about a robot and the objects that it carries. They do not depend on the world. Immutable.
struct RobotProofs
{
  std::vector<std::shared_ptr<const BallCover>> covers;   ///< one per robot instance of the problem
  std::vector<std::shared_ptr<const JointTable>> tables;  ///< one per self pair; null: the pair has none
};

/// Makes the proofs of consecutive problems, for any robots. Their parts are kept as long as their trees are in
/// use. One caller at a time.
class RobotProver
{
 public:
  /// Takes seconds for a new robot. Calls `publish` as soon as the covers are made, with the tables that are known, and
  /// again when all tables are made. `stopped` is called between the parts of the work, which take up to a second; if
  /// it returns true, the work ends.
  void prove(const RobotModel& robot, const CollisionProblem& problem, const std::shared_ptr<const CpuForest>& forest,
             const std::function<void(RobotProofs)>& publish, const std::function<bool()>& stopped);

 private:
  struct KnownShape
  {
    std::weak_ptr<const CpuTree> tree;
    std::shared_ptr<const BallCover> cover;
    SolidDepth depth;
  };
  /// One side of a pair with a table.
  struct Side
  {
    std::weak_ptr<const CpuTree> tree;
    int link;
    Eigen::Isometry3d pose;
  };
  struct KnownTable
  {
    std::weak_ptr<const RobotModel> robot;
    std::array<Side, 2> sides;
    std::shared_ptr<const JointTable> table;  // null: the pair has none
  };

  void forgetUnused();
  std::shared_ptr<const KnownShape> shape(const std::shared_ptr<const CpuTree>& tree, double sagitta);
  const KnownTable* known(const RobotModel& robot, const std::array<Side, 2>& sides) const;

  std::vector<std::shared_ptr<const KnownShape>> shapes_;
  std::vector<KnownTable> tables_;
};
}  // namespace gpu_planning_scene::core
