#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/allowed_collision_matrix.h"

namespace gpu_planning_scene::core
{
/// Removes the entries of a removed object from the matrix, and returns warnings: one for each body that the object was
/// forbidden to touch, and that a new object of this name may touch.
std::vector<std::string> removeEntriesOfObject(AllowedCollisionMatrix& matrix, const std::string& id);

/// A warning about a new matrix that has defaults but no entries: it does not allow the pairs of the robot's own
/// matrix, so they are checked. Empty if there is nothing to warn about. MoveIt takes such a matrix too, except in a
/// difference.
std::string warningOfDefaultsAlone(const RobotModel& robot, const AllowedCollisionMatrix& matrix);
}  // namespace gpu_planning_scene::core
