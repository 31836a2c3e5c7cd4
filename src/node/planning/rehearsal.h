#pragma once

#include <functional>
#include <memory>

#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/planning/planner_factory.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// Checks random states of all groups, then plans motions between those that are free, for each group in turn. The
/// paths are thrown away. Later plans in this scene find prepared what all plans need: proofs, bounds of motions,
/// memory, and the pairs of bodies in the order in which they mostly collide. Ends after 12,000 states, after 0.1 s of
/// plans, or when `stop` returns true; the last plan may end up to 0.3 s later. Groups that cannot be planned for are
/// left out.
void rehearsePlans(const std::shared_ptr<const PlanningScene>& scene, const std::shared_ptr<StateChecker>& checker,
                   const MotionCheckerOptions& motions, const PlannerFactory& factory,
                   const std::function<bool()>& stop);
}  // namespace gpu_planning_scene::core
