#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Straight motions between states of a GroupStateSpace, within its bounds: see MotionChecker for when one is valid.
/// The start is checked as well. A state with a value that is not finite is outside of the bounds. The robot's other
/// variables are as for StateValidityChecker. Thread-safe.
class MotionValidator : public ompl::base::MotionValidator
{
 public:
  using Motion = std::pair<const ompl::base::State*, const ompl::base::State*>;
  using Termination = ompl::base::PlannerTerminationCondition;

  /// `checker` has `scene`. Throws Error if the space of `information` is no GroupStateSpace of the scene's robot.
  MotionValidator(const ompl::base::SpaceInformationPtr& information, std::shared_ptr<const PlanningScene> scene,
                  std::shared_ptr<StateChecker> checker, const MotionCheckerOptions& options = {});

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override;
  /// `last_valid`, which stays as it is where the motion is valid: the last free sample before the first collision, or
  /// what MotionVerdict::last_valid is, and its fraction; the start and 0 where that collides. The state may be null.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last_valid) const override;

  /// In bulk: 1 for each motion that is valid, else 0. Motions that are not decided when `ptc` says so are not valid.
  std::vector<std::uint8_t> validateMotions(const std::vector<Motion>& motions, const Termination& ptc = never()) const;
  /// In bulk: 1 for each motion whose samples are free. For planners that have only the motions of a solution proven:
  /// see MotionRule.
  std::vector<std::uint8_t> validateSamples(const std::vector<Motion>& motions, const Termination& ptc = never()) const;
  MotionRule rule() const { return motions_.rule(); }
  /// Whether all motions of the path are valid, in one batch; of one state, whether it is.
  bool validatePath(const ompl::geometric::PathGeometric& path, const Termination& ptc = never()) const;

  /// States that were checked so far.
  std::uint64_t statesChecked() const { return motions_.statesChecked(); }

 private:
  static Termination never() { return ompl::base::plannerNonTerminatingCondition(); }
  std::vector<MotionVerdict> check(const std::vector<Motion>& motions, MotionQuery question,
                                   const Termination& ptc) const;
  static std::vector<std::uint8_t> validOf(const std::vector<MotionVerdict>& verdicts);

  std::shared_ptr<const GroupStateSpace> space_;
  std::vector<double> reference_;  // a row of all variables
  MotionChecker motions_;
  mutable std::mutex counters_;  // OMPL's, of valid and invalid motions
};
}  // namespace gpu_planning_scene::core
