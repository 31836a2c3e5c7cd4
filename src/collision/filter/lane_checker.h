#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/cpu_traversal.h"
#include "collision/filter/lane_kernel.h"
#include "collision/filter/lane_scene.h"
#include "collision/filter/proof_worker.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Checks blocks of states: most verdicts are proven by balls and tables, eight states at a time; the exact checker
/// decides the pairs that remain. So the verdicts are those of the exact checker.
class LaneChecker
{
 public:
  /// Work space of one thread.
  struct Scratch
  {
    std::vector<float> floats;
    std::vector<std::uint8_t> placed;
    std::vector<std::uint32_t> open;
    std::vector<Eigen::Isometry3d> poses;
    std::vector<CpuTraversal::InstancePair> pairs;
    std::vector<std::uint32_t> hits;  // of each pair: collisions that the exact checker found
    CpuTraversal::Scratch exact;
  };

  /// Starts to make the proofs in the background. `traversal` must outlive the checker.
  LaneChecker(std::shared_ptr<const RobotModel> robot, std::shared_ptr<const CollisionProblem> problem,
              std::shared_ptr<const CpuForest> forest, const CpuTraversal& traversal);

  /// Whether the proofs are made. One caller at a time.
  bool isReady();

  /// Whether `check` may be called for a state.
  bool takes(const double* state) const { return scene_->isWithinBounds(state); }

  /// Checks `count` states (1 to lanes::kLanes rows) and sets rows `row` and following of `result`, which must be
  /// initialised as free. The problem must be valid for the states, and `takes` true. Thread-safe if each thread has its
  /// own scratch.
  void check(const double* states, std::size_t count, std::size_t row, Scratch& scratch, BatchResult& result) const;

 private:
  lanes::Scratch kernelScratch(Scratch& scratch) const;

  std::shared_ptr<const RobotModel> robot_;
  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const CpuForest> forest_;
  const CpuTraversal& traversal_;
  std::shared_ptr<ProofJob> job_;
  std::unique_ptr<const LaneScene> scene_;  // null until the proofs are made
  lanes::Kernel kernel_;
};
}  // namespace gpu_planning_scene::core
