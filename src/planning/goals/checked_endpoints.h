#pragma once

#include <string>
#include <vector>

#include <ompl/base/ScopedState.h>

#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning/path_constraints.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// The start and the goals of a query, after their check.
struct CheckedEndpoints
{
  PlanningStatus status = PlanningStatus::Solved;  ///< else the fault of the start or of the first goal
  std::string message;                             ///< describes the fault
  std::vector<ompl::base::ScopedState<>> goals;    ///< the goals that are within bounds and free of collision
  /// The fault of the first goal state, if no goal state is valid and the query also has goal regions.
  std::string fault_beside_regions = {};
};

/// Checks the start and all goal states of the query in one batch. `checker` holds `scene` already. The rows of the
/// query have one value per variable of the robot. `constraints`: of the path, or null.
CheckedEndpoints checkEndpoints(const PlanningScene& scene, StateChecker& checker,
                                const ompl::base::StateSpacePtr& space, const PlanningQuery& query,
                                const PathConstraints* constraints);
}  // namespace gpu_planning_scene::core
