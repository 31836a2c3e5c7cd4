#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/problem/collision_problem.h"
#include "collision/proofs/ball_cover.h"
#include "collision/proofs/joint_table.h"
#include "collision/proofs/proof_cache.h"
#include "collision/proofs/proof_key.h"
#include "collision/proofs/stopped.h"
#include "collision/trees/cpu_forest.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The proofs about a robot and the objects that it carries. They do not depend on the world. Immutable.
struct RobotProofs
{
  std::vector<std::shared_ptr<const BallCover>> covers;   ///< one per robot instance of the problem
  std::vector<std::shared_ptr<const JointTable>> tables;  ///< one per self pair; null: none, or not made yet
  bool has_all_tables = false;                            ///< no table is still to be made

  /// Whether both are the same objects.
  bool isSame(const RobotProofs& other) const
  {
    return covers == other.covers && tables == other.tables && has_all_tables == other.has_all_tables;
  }
};

/// The proofs that are available.
enum class ProofStage
{
  None,
  Covers,  ///< all covers, and the tables that needed no work
  All
};

/// Makes the proofs of consecutive problems, for any robots. Covers and tables are kept as long as their trees are in
/// use. One caller at a time.
class RobotProver
{
 public:
  /// Receives the proofs.
  using Publish = std::function<void(RobotProofs)>;

  /// Publishes the proofs of a problem if all of them are known or in the cache; otherwise nothing. Takes milliseconds.
  void load(const RobotModel& robot, const CollisionProblem& problem, const std::shared_ptr<const CpuForest>& forest,
            const ProofCache& cache, const Publish& publish, const Stopped& stopped);

  /// Takes proofs from the cache, makes the missing ones on all cores, and stores them in the cache. This takes seconds
  /// for a new robot. Publishes as soon as it has all covers, with the tables that are known or in the cache. If tables
  /// are missing, it publishes again when they are made. `published`: the newest proofs that it has published for this
  /// problem, which it does not publish again; null: none.
  ///
  /// If `stopped` returns true, the work ends within milliseconds. If `paused` returns true, no further cover or table
  /// is begun; each call makes at least one. Returns whether there is nothing more to make. After a pause, another call
  /// goes on, because covers and tables are kept.
  bool prove(const RobotModel& robot, const CollisionProblem& problem, const std::shared_ptr<const CpuForest>& forest,
             const ProofCache& cache, const Publish& publish, const Stopped& stopped, const Stopped& paused = {},
             const RobotProofs* published = nullptr);

 private:
  struct KnownShape
  {
    std::weak_ptr<const CpuTree> tree;
    ShapeHash hash;
    std::shared_ptr<const BallCover> cover;  // null: neither loaded nor made yet
    std::optional<SolidDepth> depth;         // only if a cover or a table of the shape was made
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
  /// A self pair whose table is neither known nor in the cache.
  struct MissingTable
  {
    std::size_t pair;
    std::string key;
  };
  /// The proofs that are known or in the cache.
  struct Found
  {
    RobotProofs proofs;
    std::vector<std::shared_ptr<KnownShape>> shapes;  // of each instance
    std::vector<MissingTable> missing;
  };

  void forgetUnused();
  std::shared_ptr<KnownShape> shape(const std::shared_ptr<const CpuTree>& tree, double sagitta,
                                    const ProofCache& cache);
  static void makeCover(KnownShape& shape, const CpuTree& tree, double sagitta, const ProofCache& cache,
                        const Stopped& stopped);
  const KnownTable* known(const RobotModel& robot, const std::array<Side, 2>& sides) const;
  void findTables(const RobotModel& robot, const CollisionProblem& problem, const CpuForest& forest,
                  const ProofCache& cache, Found& found);
  bool makeTables(const RobotModel& robot, const CollisionProblem& problem,
                  const std::shared_ptr<const CpuForest>& forest, const ProofCache& cache, Found& found,
                  const Stopped& stopped, const Stopped& paused);

  std::vector<std::shared_ptr<KnownShape>> shapes_;
  std::vector<KnownTable> tables_;
};
}  // namespace gpu_planning_scene::core
