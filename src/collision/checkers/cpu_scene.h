#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "collision/bounds/displacement_bounds.h"
#include "collision/bounds/problem_maker.h"
#include "collision/exact/cpu_traversal.h"
#include "collision/exact/forest_cache.h"
#include "collision/filter/lanes/lane_checker.h"

namespace gpu_planning_scene::core
{
/// Making the proofs of a robot takes seconds to a minute on all cores. They are made only after this many checked
/// states.
constexpr std::size_t kStatesBeforeProofs = 20'000;

/// The collision problems of a scene, one per group, and their checks on the CPU. A problem is made when it is first
/// needed. Trees are kept for the next scene with the same shapes. Thread-safe, and checks run side by side. Exception:
/// no other call may run during setScene.
class CpuScene
{
 public:
  /// Throws Error for an invalid tolerance.
  explicit CpuScene(const CheckerOptions& options);

  /// Throws Error and keeps the old scene if this one cannot be used.
  void setScene(std::shared_ptr<const PlanningScene> scene);
  const std::shared_ptr<const PlanningScene>& scene() const { return scene_; }

  /// This and the functions below throw Error for an unknown group.
  SceneReport report(const std::string& group);
  const std::shared_ptr<const CollisionProblem>& problem(const std::string& group);

  /// The trees of the CPU's traversals.
  const std::shared_ptr<ForestCache>& trees() const { return forest_; }

  /// Prepares the group, so that the first call of `check` need not do so.
  void prepare(const std::string& group);

  /// The proofs with which `check` decides most states of the group. Requests them once enough states have been
  /// checked.
  ProofStage proofStage(const std::string& group);

  /// The proofs of proofStage; null: none.
  std::shared_ptr<const RobotProofs> proofs(const std::string& group);

  /// Counts states of the group that were checked elsewhere, so that proofs are made for a robot in use.
  void countStates(std::size_t count, const std::string& group);

  /// The margins of the group's pairs for `count` states (rows of the robot's variables). Throws Error if `around` does
  /// not fit the states.
  Margins margins(const JointNeighbourhood& around, const double* states, std::size_t count, const std::string& group);

  /// Checks `count` states on all cores and fills `valid` and `colliding`. All states are allowed, also those for which
  /// `problem` is not valid. `margins`: margins of the group for these states; null: none.
  void check(const double* states, std::size_t count, const std::string& group, BatchResult& result,
             const Margins* margins = nullptr);

 private:
  /// Work space of one thread, including the learned order of checks.
  struct Scratch
  {
    explicit Scratch(const std::shared_ptr<DecisionTotals>& decisions)
    {
      lanes.tally.countFor(decisions);
      near_lanes.tally.countFor(decisions);
    }

    CpuTraversal::Scratch within;     // for states for which the problem is valid
    CpuTraversal::Scratch outside;    // for the other states
    CpuTraversal::Scratch near;       // for states with margins
    LaneChecker::Scratch lanes;       // for blocks of states for which the problem is valid
    LaneChecker::Scratch near_lanes;  // for such blocks with margins
    std::vector<Eigen::Isometry3d> poses;
  };
  struct Group
  {
    SceneReport report;
    bool is_sampled = false;  // the report has the pairs of collidingInSamples
    std::shared_ptr<const CollisionProblem> problem;
    std::unique_ptr<const CpuTraversal> within;   // traversal of this problem
    std::shared_ptr<ProofJob> cached_proofs;      // null: not requested
    std::unique_ptr<LaneChecker> lanes;           // for states for which the problem is valid; null: not used
    std::unique_ptr<const CpuTraversal> outside;  // all pairs, for states for which the problem is not valid
    std::unique_ptr<const DisplacementBounds> displacements;
    std::uint64_t checked = 0;  // states
    std::shared_ptr<DecisionTotals> decisions = std::make_shared<DecisionTotals>();
    std::vector<std::unique_ptr<Scratch>> scratches;  // that no check uses now; the last one was used last
    std::size_t scratch_count = 0;                    // with those that checks use
  };
  class ScratchLoan;

  // The caller of these functions holds mutex_.
  Group& groupOf(const std::string& group);
  void prepare(Group& group);
  ProofStage proofStage(Group& group) const;
  void loadProofs(Group& group, std::size_t count) const;
  void prepareOutside(const std::string& name, Group& group);
  bool countSlice(std::size_t count, Group& group, Scratch& scratch, bool has_margins);

  bool areValid(const double* states, std::size_t count, const CollisionProblem& problem) const;
  void checkBlock(const double* states, std::size_t begin, std::size_t end, const Group& group, const Margins* margins,
                  bool by_lanes, Scratch& scratch, BatchResult& result) const;
  void checkRow(const double* state, std::size_t row, const Group& group, const Margins* margins, Scratch& scratch,
                BatchResult& result) const;

  CheckerOptions options_;
  ProblemMaker maker_;
  JointLevers levers_;
  std::shared_ptr<const PlanningScene> scene_;
  std::mutex mutex_;  // of the members below, and of their changes; checks read a prepared group without it
  std::map<std::string, Group> groups_;
  std::size_t checked_ = 0;  // states, of all scenes
  std::shared_ptr<ForestCache> forest_ = std::make_shared<ForestCache>();
  ForestCache forest_outside_;
};
}  // namespace gpu_planning_scene::core
