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
/// A state of a GroupStateSpace is valid if it is within the bounds of the space and free of collision in the scene.
/// The robot's other variables have the values of the scene's current state, or of RobotModel::defaultState() if the
/// scene has none. Thread-safe.
class StateValidityChecker : public ompl::base::StateValidityChecker
{
 public:
  /// `scene`: that of the checker (StateChecker::setScene); this is not verified. Throws Error if the space of
  /// `information` is not a GroupStateSpace of the robot of `scene`.
  StateValidityChecker(const ompl::base::SpaceInformationPtr& information, std::shared_ptr<const PlanningScene> scene,
                       std::shared_ptr<StateChecker> checker);

  bool isValid(const ompl::base::State* state) const override;
  using ompl::base::StateValidityChecker::isValid;
  /// The smaller of Clearance::world and Clearance::self, in metres beyond the required distance: see StateInspector.
  /// The bounds of the space do not count. Throws Error for a value that is not finite.
  double clearance(const ompl::base::State* state) const override;
  using ompl::base::StateValidityChecker::clearance;

  /// Validates many states in one call. Returns one byte per state: 1 if the state is valid, else 0.
  std::vector<std::uint8_t> validateStates(const std::vector<const ompl::base::State*>& states) const;

  /// Number of states checked so far. States out of bounds are not checked and do not count.
  std::uint64_t statesChecked() const { return states_checked_; }

 private:
  std::shared_ptr<const GroupStateSpace> space_;
  std::shared_ptr<const PlanningScene> scene_;
  std::shared_ptr<StateChecker> checker_;
  std::vector<double> reference_;  // one value per variable of the robot
  mutable std::once_flag inspector_made_;
  mutable std::unique_ptr<StateInspector> inspector_;
  mutable std::atomic<std::uint64_t> states_checked_{0};
};
}  // namespace gpu_planning_scene::core
