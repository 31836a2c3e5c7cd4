#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include <ompl/base/StateValidityChecker.h>

#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/state_checker.h"
#include "gpu_planning_scene/state_inspector.h"

namespace gpu_planning_scene::core
{
/// Whether states of a GroupStateSpace are within its bounds and free of collision in a scene. The robot's other
/// variables are as in the scene's current state, or RobotModel::defaultState() where it has none. Thread-safe.
class StateValidityChecker : public ompl::base::StateValidityChecker
{
 public:
  /// `checker` has `scene`. Throws Error if the space of `information` is no GroupStateSpace of the scene's robot.
  StateValidityChecker(const ompl::base::SpaceInformationPtr& information, std::shared_ptr<const PlanningScene> scene,
                       std::shared_ptr<StateChecker> checker);

  bool isValid(const ompl::base::State* state) const override;
  using ompl::base::StateValidityChecker::isValid;
  /// Metres beyond the required distance to the nearest of the world and of the robot itself: see StateInspector.
  /// Bounds do not count. Throws Error for a value that is not finite.
  double clearance(const ompl::base::State* state) const override;
  using ompl::base::StateValidityChecker::clearance;

  /// In bulk: 1 for each state that is valid, else 0.
  std::vector<std::uint8_t> validateStates(const std::vector<const ompl::base::State*>& states) const;

  /// States that were checked so far; those out of bounds never are.
  std::uint64_t statesChecked() const { return states_checked_; }

 private:
  std::shared_ptr<const GroupStateSpace> space_;
  std::shared_ptr<const PlanningScene> scene_;
  std::shared_ptr<StateChecker> checker_;
  std::vector<double> reference_;  // a row of all variables
  mutable std::once_flag inspector_made_;
  mutable std::unique_ptr<StateInspector> inspector_;
  mutable std::atomic<std::uint64_t> states_checked_{0};
};
}  // namespace gpu_planning_scene::core
