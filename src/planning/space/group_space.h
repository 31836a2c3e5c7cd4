#pragma once

#include <memory>
#include <vector>

#include <ompl/base/SpaceInformation.h>

#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// The state space of `information`. Throws Error if it is not a GroupStateSpace of the scene's robot.
std::shared_ptr<const GroupStateSpace> groupSpaceOf(const ompl::base::SpaceInformation& information,
                                                    const PlanningScene& scene);

/// Throws Error if the group moves a joint with Joint::diff_drive: neither the planners nor the straight lines keep it
/// on its heading.
void requireHolonomic(const RobotModel& robot, const Group& group);

/// A row of all variables of the robot: the scene's current state, or RobotModel::defaultState() if the scene has none.
std::vector<double> referenceState(const PlanningScene& scene);

/// True if a state is within the bounds of the space and all its values are finite. (OMPL's bounds accept values that
/// are not finite.)
bool isWithin(const GroupStateSpace& space, const ompl::base::State* state);

/// Appends a copy of the reference row with the values of the state.
void appendRow(const GroupStateSpace& space, const std::vector<double>& reference, const ompl::base::State* state,
               std::vector<double>& rows);
}  // namespace gpu_planning_scene::core
