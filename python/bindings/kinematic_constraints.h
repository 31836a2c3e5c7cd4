#pragma once

#include <memory>
#include <vector>

#include "bindings/arguments.h"
#include "gpu_planning_scene/kinematic_constraints.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::python
{
/// Python's KinematicConstraints. The functions throw Error and change nothing for a constraint that is not valid.
struct SceneConstraints
{
  std::shared_ptr<const core::PlanningScene> scene;  ///< whose frames the constraints name
  core::KinematicConstraints all;

  void append(const core::KinematicConstraints& more);
  void add(const core::PositionConstraint& position);
  void add(const core::OrientationConstraint& orientation);
};

/// None, a KinematicConstraints, or a list or tuple of them. Throws TypeError, and Error if they are for another robot.
/// `what`: for the message.
std::vector<core::KinematicConstraints> constraintsFrom(py::handle object, const core::PlanningScene& scene,
                                                        const char* what);
}  // namespace gpu_planning_scene::python
