#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "collision/cpu/lanes/decision_tally.h"
#include "collision/cpu/lanes/lane_buffers.h"
#include "collision/cpu/lanes/lane_kernel.h"
#include "collision/cpu/lanes/lane_scene.h"
#include "collision/exact/exact_checker.h"
#include "collision/proofs/proof_worker.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Checks blocks of up to eight states. Balls and tables prove most verdicts, for all states of a block at once. The
/// exact checker decides the pairs that remain. So the verdicts are those of the exact checker.
class LaneChecker
{
 public:
  /// The results and the cost of the exact tests of a pair.
  struct PairRecord
  {
    double hits = 0.0;  // collisions found
    double cost = 1.0;  // steps, see CpuShapePair::Scratch
  };

  /// Work space of one thread.
  struct Scratch
  {
    std::shared_ptr<const LaneScene> scene;  // to which `buffers` and `records` belong
    LaneBuffers buffers;
    std::vector<float> margins;
    std::vector<Eigen::Isometry3d> poses;  // of links
    std::vector<std::uint8_t> known;       // of each link: whether its pose is set
    std::vector<ExactChecker::OpenPair> pairs;
    std::vector<PairRecord> records;  // of each pair
    std::vector<std::uint64_t> steps;
    ExactChecker::Scratch exact;
    DecisionTally tally;
  };

  /// Whether a LaneChecker saves time for a problem. With many thousands of pairs it does not: the kernel tests each
  /// pair of a link and an object, while the exact checker has a tree over the objects.
  static bool suits(const CollisionProblem& problem);

  /// `exact` must outlive the checker.
  LaneChecker(std::shared_ptr<const RobotModel> robot, std::shared_ptr<const CollisionProblem> problem,
              std::shared_ptr<const CpuForest> forest, const ExactChecker& exact);

  /// The stage of the newest proofs. The first call starts to make proofs in the background. One caller at a time.
  ProofStage requestProofs();

  /// The newest proofs; null: none, or not requested. One caller at a time.
  std::shared_ptr<const RobotProofs> proofs() const { return job_ ? job_->proofs() : nullptr; }

  /// From now on, `check` uses the newest proofs with this scratch. Must be called before the first `check` with it,
  /// after `requestProofs` has returned another stage than None. One caller at a time.
  void useProofs(Scratch& scratch);

  /// Whether `check` may be called for a state.
  static bool takes(const double* state, const Scratch& scratch) { return scratch.scene->isWithinBounds(state); }

  /// Checks `count` states (1 to lanes::kLanes rows), which are the rows `row` and following of `result`. For each one
  /// that collides, sets `valid` to 0, and its pair; leaves the other rows as they are. `margins`: of each state, see
  /// ExactChecker::firstCollision; null: no margins. The problem must be valid for the states, and `takes` true.
  /// Thread-safe if each thread has its own scratch; states with and without margins should have different ones,
  /// because the scratch learns which tests pay.
  void check(const double* states, std::size_t count, std::size_t row, const double* const* margins, Scratch& scratch,
             BatchResult& result) const;

 private:
  const float* kernelMargins(const double* const* margins, std::size_t count, Scratch& scratch) const;
  double marginOf(std::uint32_t pair, const double* margins, const LaneScene& scene) const;
  std::optional<BodyPair> decideOpenPairs(const double* state, std::uint32_t* open, std::size_t open_count,
                                          const double* margins, Scratch& scratch) const;

  std::shared_ptr<const RobotModel> robot_;
  std::shared_ptr<const CollisionProblem> problem_;
  std::shared_ptr<const CpuForest> forest_;
  const ExactChecker& exact_;
  std::shared_ptr<ProofJob> job_;  // null before the first call of requestProofs
  std::shared_ptr<const RobotProofs> proofs_;
  std::shared_ptr<const LaneScene> scene_;  // made with proofs_
  lanes::Kernel kernel_;
};
}  // namespace gpu_planning_scene::core
