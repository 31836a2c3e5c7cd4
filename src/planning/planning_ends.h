#pragma once

#include <string>
#include <vector>

#include <ompl/base/ScopedState.h>

#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// What a query can be planned between.
struct PlanningEnds
{
  PlanningStatus status = PlanningStatus::Solved;  ///< else what is wrong with the start, or with all goals
  std::string message;                             ///< which says so
  std::vector<ompl::base::ScopedState<>> goals;    ///< those that are within bounds and free of collision
};

/// Looks at the start and all goals, in one batch. `checker` has `scene`. The query's rows are of the robot's
/// variables.
PlanningEnds findEnds(const PlanningScene& scene, StateChecker& checker, const ompl::base::StateSpacePtr& space,
                      const PlanningQuery& query);
}  // namespace gpu_planning_scene::core
