#pragma once

#include <memory>
#include <string>

#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/planning/planner_factory.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Plans motions between random free states of a group, for 30 ms at most. They leave no path behind, but the plans
/// that follow find prepared what all plans need: proofs, bounds of motions, memory, and the pairs of bodies in the
/// order in which they mostly collide. Does nothing if few states are free. Errors of planMotion pass through.
void rehearsePlans(const std::shared_ptr<const PlanningScene>& scene, const std::shared_ptr<StateChecker>& checker,
                   const std::string& group, const MotionCheckerOptions& motions, const PlannerFactory& factory);
}  // namespace gpu_planning_scene::core
