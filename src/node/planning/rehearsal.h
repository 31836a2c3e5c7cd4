#pragma once

#include <functional>
#include <memory>

#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/planning/planner_factory.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Checks random states of all groups, then plans motions between those that are free. The paths are thrown away. Later
/// plans find prepared what all plans need: proofs, bounds of motions, memory, and the pairs of bodies in the order in
/// which they mostly collide. The plans take 0.1 s in all; the last one may end up to 0.3 s later. Ends early when
/// `stop` returns true. Groups that cannot be planned for are left out.
void rehearsePlans(const std::shared_ptr<const PlanningScene>& scene, const std::shared_ptr<StateChecker>& checker,
                   const MotionCheckerOptions& motions, const PlannerFactory& factory,
                   const std::function<bool()>& stop);
}  // namespace gpu_planning_scene::core
