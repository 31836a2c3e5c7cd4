#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning/path_constraints.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Validates straight motions between states of a GroupStateSpace. A motion is valid if its states are within the
/// bounds of the space and the MotionChecker finds it valid. The start is checked too, except by validateExtensions. A
/// state with a value that is not finite is outside of the bounds. The robot's other variables have the values
/// described at StateValidityChecker. Thread-safe.
class MotionValidator : public ompl::base::MotionValidator
{
 public:
  using Motion = std::pair<const ompl::base::State*, const ompl::base::State*>;
  using Termination = ompl::base::PlannerTerminationCondition;

  /// `scene`: that of the checker (StateChecker::setScene); this is not verified. Throws Error if the space of
  /// `information` is not a GroupStateSpace of the robot of `scene`.
  MotionValidator(const ompl::base::SpaceInformationPtr& information, std::shared_ptr<const PlanningScene> scene,
                  std::shared_ptr<StateChecker> checker, const MotionCheckerOptions& options = {});

  /// From now on, a motion is valid only if it is also proven to fulfil the constraints
  /// (PathConstraints::holdAlong). Call this before the first check. Null: no constraints.
  void constrain(std::shared_ptr<const PathConstraints> constraints) { constraints_ = std::move(constraints); }
  bool isConstrained() const { return constraints_ != nullptr; }
  /// Moves a state to a near one that fulfils the constraints. Returns false, with an undefined state, if there is none
  /// near it.
  bool project(ompl::base::State* state) const;

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override;
  /// If the motion is invalid, `last_valid` receives MotionVerdict::last_valid and the state at this fraction; if the
  /// start collides, these are 0 and the start. If the motion is valid, `last_valid` stays unchanged. The state pointer
  /// may be null.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last_valid) const override;

  /// Validates many motions in one call. Returns one byte per motion: 1 if the motion is valid, else 0. When `ptc`
  /// returns true, all motions without a verdict get 0.
  std::vector<std::uint8_t> validateMotions(const std::vector<Motion>& motions, const Termination& ptc = never()) const;
  /// Checks samples of many motions in one call, at kCoarser times the steps of the options, whatever the rule is.
  /// Returns one byte per motion: 1 if these samples are free, else 0. Planners use this function if they validate only
  /// the motions of a solution by the rule.
  std::vector<std::uint8_t> validateCoarsely(const std::vector<Motion>& motions,
                                             const Termination& ptc = never()) const;
  /// As validateCoarsely, for motions that extend a tree. The start of each must be a vertex of the tree, which is
  /// known to be free, or the end of the motion before it. It is not checked, so a 1 counts only if the motions before
  /// it, up to the tree, have 1 too. The ends are checked first.
  std::vector<std::uint8_t> validateExtensions(const std::vector<Motion>& motions,
                                               const Termination& ptc = never()) const;
  static constexpr double kCoarser = 4.0;
  MotionRule rule() const { return motions_.rule(); }
  bool checksSideBySide() const { return motions_.checksSideBySide(); }  ///< see StateChecker
  /// From now on, a motion that validateMotions or validatePath has found valid counts as valid again, without a check
  /// (100,000 of them at most). So the last check of a path costs nothing if its planner has proven the path. Call this
  /// only if the checker keeps its scene.
  void rememberValidMotions() { remembers_ = true; }
  /// Checks all motions of the path in one batch. Returns true if all motions are valid. A path with one state is valid
  /// if the state is valid. An empty path is not valid.
  bool validatePath(const ompl::geometric::PathGeometric& path, const Termination& ptc = never()) const;

  /// Number of states checked so far.
  std::uint64_t statesChecked() const { return motions_.statesChecked() + coarse_motions_.statesChecked(); }

 private:
  static Termination never() { return ompl::base::plannerNonTerminatingCondition(); }
  std::vector<MotionVerdict> check(const MotionChecker& checker, const std::vector<Motion>& motions, MotionQuery query,
                                   const Termination& ptc) const;
  static std::vector<std::uint8_t> validOf(const std::vector<MotionVerdict>& verdicts);

  std::shared_ptr<const GroupStateSpace> space_;
  std::vector<double> reference_;  // one value per variable of the robot
  std::shared_ptr<const PathConstraints> constraints_;
  MotionChecker motions_;
  MotionChecker coarse_motions_;
  std::atomic<bool> remembers_{false};
  mutable std::mutex mutex_;  // guards the set below, and OMPL's counters of valid and invalid motions
  mutable std::unordered_set<std::string> valid_motions_;  // the bytes of the values of the start and the end
};
}  // namespace gpu_planning_scene::core
