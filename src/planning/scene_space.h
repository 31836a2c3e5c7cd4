#pragma once

#include <memory>
#include <vector>

#include <ompl/base/SpaceInformation.h>

#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// The space of `information`. Throws Error if it is no GroupStateSpace of the scene's robot.
std::shared_ptr<const GroupStateSpace> groupSpaceOf(const ompl::base::SpaceInformation& information,
                                                    const PlanningScene& scene);

/// A row of all variables of the robot: the scene's current state, or RobotModel::defaultState() where it has none.
std::vector<double> referenceState(const PlanningScene& scene);

/// Whether a state of the space is within its bounds; not where a value is not finite, which OMPL's bounds let pass.
bool isWithin(const GroupStateSpace& space, const ompl::base::State* state);

/// Appends the reference row with the state's values in it.
void appendRow(const GroupStateSpace& space, const std::vector<double>& reference, const ompl::base::State* state,
               std::vector<double>& rows);
}  // namespace gpu_planning_scene::core
