#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "collision/bounds/displacement_bounds.h"
#include "collision/bounds/problem_maker.h"
#include "collision/cpu/lanes/lane_checker.h"
#include "collision/exact/exact_checker.h"
#include "collision/exact/forest_cache.h"
#include "collision/problem/state_range.h"

namespace gpu_planning_scene::core
{
/// Making the proofs of a robot takes seconds to a minute on all cores. They are made only after this many checked
/// states.
constexpr std::size_t kStatesBeforeProofs = 20'000;

/// The collision problems of a scene, one per group, and their checks on the CPU. A problem is made when it is first
/// needed. Trees are kept for the next scene with the same shapes. Thread-safe, and checks run side by side. Exception:
/// no other call may run, and no Core may exist, during setScene.
class CpuScene
{
 public:
  explicit CpuScene(const CheckerOptions& options);

  /// `is_prepared`: prepares the group "" too. Throws Error and keeps the old scene if this one cannot be used.
  void setScene(std::shared_ptr<const PlanningScene> scene, bool is_prepared);
  const std::shared_ptr<const PlanningScene>& scene() const { return scene_; }

  /// This and the functions below throw Error for an unknown group.
  SceneReport report(const std::string& group);
  const std::shared_ptr<const CollisionProblem>& problem(const std::string& group);

  /// Prepares the group, so that the first call of `check` need not do so.
  void prepare(const std::string& group);

  /// The proofs with which `check` decides most states of the group. Requests them once enough states have been
  /// checked.
  ProofStage proofStage(const std::string& group);

  /// The scene of the group for devices, with the newest proofs; null: there are no proofs.
  std::shared_ptr<const LaneScene> deviceProofs(const std::string& group);

  /// Counts a batch of which devices answered `by_devices` states, so that proofs are loaded or made for a robot in
  /// use.
  void countBatch(std::size_t count, std::size_t by_devices, const std::string& group);

  /// The margins of the group's pairs for `count` states (rows of the robot's variables). Throws Error if `around` does
  /// not fit the states.
  Margins margins(const JointNeighbourhood& around, const double* states, std::size_t count, const std::string& group);

 private:
  struct Scratch;
  struct Group;

 public:
  /// Checks states of a group on the thread of its user, with a work space that learns. Others can be used at the same
  /// time, on other threads.
  class Core
  {
   public:
    /// Prepares the group.
    Core(CpuScene& scene, const std::string& group);
    ~Core();
    Core(const Core&) = delete;
    Core& operator=(const Core&) = delete;

    /// For each state of `part` that collides, sets `valid` to 0, and its pair; leaves the other states as they are.
    /// `states`, `margins`: of the whole batch. All states are allowed, also those for which `problem` is not valid.
    /// Returns the number of states.
    std::size_t check(const double* states, const std::vector<StateRange>& part, const Margins* margins,
                      BatchResult& result);

    /// Ends a batch of `count` states that this core has checked alone: gives the work space back, counts the states
    /// and loads proofs as CpuScene::countBatch does, with one lock. `check` must not be called afterwards.
    void endBatch(std::size_t count);

   private:
    void giveBack();
    void checkBlock(const double* states, std::size_t begin, std::size_t end, const Margins* margins, bool by_lanes,
                    BatchResult& result);
    void checkRow(const double* state, std::size_t row, const Margins* margins, BatchResult& result);
    const ExactChecker& outside();

    CpuScene& scene_;
    const std::string name_;
    Group* group_ = nullptr;
    const ExactChecker* outside_ = nullptr;  // null: not needed yet
    std::unique_ptr<Scratch> scratch_;
    std::size_t uncounted_ = 0;  // states that the scene has not counted yet
  };

 private:
  /// Work space of one thread, including the learned order of checks.
  struct Scratch
  {
    explicit Scratch(const std::shared_ptr<DecisionTotals>& decisions)
    {
      lanes.tally.countFor(decisions);
      near_lanes.tally.countFor(decisions);
    }

    ExactChecker::Scratch within;     // for states for which the problem is valid
    ExactChecker::Scratch outside;    // for the other states
    ExactChecker::Scratch near;       // for states with margins
    LaneChecker::Scratch lanes;       // for blocks of states for which the problem is valid
    LaneChecker::Scratch near_lanes;  // for such blocks with margins
    std::vector<Eigen::Isometry3d> poses;
  };
  struct Group
  {
    SceneReport report;
    bool is_sampled = false;  // the report has the pairs of collidingInSamples
    std::shared_ptr<const CollisionProblem> problem;
    std::unique_ptr<const ExactChecker> within;        // of this problem
    std::shared_ptr<ProofJob> cached_proofs;           // null: not requested
    std::unique_ptr<LaneChecker> lanes;                // for states for which the problem is valid; null: not used
    std::shared_ptr<const RobotProofs> device_proofs;  // of device_scene
    std::shared_ptr<const LaneScene> device_scene;     // null: not made
    std::unique_ptr<const ExactChecker> outside;       // all pairs, for states for which the problem is not valid
    std::unique_ptr<const DisplacementBounds> displacements;
    std::uint64_t checked = 0;  // states
    std::shared_ptr<DecisionTotals> decisions = std::make_shared<DecisionTotals>();
    std::vector<std::unique_ptr<Scratch>> scratches;  // that no check uses now; the last one was used last
    std::size_t scratch_count = 0;                    // with those that checks use
  };
  // The caller of these functions holds mutex_.
  Group& groupOf(const std::string& group);
  void prepare(Group& group, const std::shared_ptr<const RobotModel>& robot);
  ProofStage proofStage(Group& group) const;
  void loadProofs(Group& group, std::size_t count) const;
  void countStates(std::size_t count, Group& group);
  bool prepareLanes(Group& group, Scratch& scratch, bool has_margins);

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
