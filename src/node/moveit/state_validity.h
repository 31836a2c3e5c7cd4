#pragma once

#include "node/checks/check_services.h"
#include "node/moveit/moveit_messages.h"
#include "node/scene/scene_services.h"

namespace gpu_planning_scene::core
{
/// Answers MoveIt's service check_state_validity. Thread-safe.
class StateValidity
{
 public:
  /// `max_contacts`: in one response. The first three arguments must outlive this object.
  StateValidity(const SceneStore& store, const SceneServices& changes, CheckServices& checks, std::size_t max_contacts);

  /// As MoveIt does, it checks the request's robot state for this request alone, with its attached objects. Joints that
  /// the request does not name keep their current values. A robot state with joint values and without is_diff replaces
  /// the attached objects. Constraints are not evaluated, and there are no cost sources. Throws Error, also for
  /// constraints.
  MoveItStateValidity::Response answer(const StateValidityRequest& request) const;

 private:
  const SceneStore& store_;
  const SceneServices& changes_;
  CheckServices& checks_;
  const std::size_t max_contacts_;
};
}  // namespace gpu_planning_scene::core
