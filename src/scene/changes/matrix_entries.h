#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/allowed_collision_matrix.h"

namespace gpu_planning_scene::core
{
/// Removes the entries of a removed object from the matrix, and returns warnings: one for each body that the object was
/// forbidden to touch, and that a new object of this name may touch.
std::vector<std::string> removeEntriesOfObject(AllowedCollisionMatrix& matrix, const std::string& id);

/// Warnings about a new matrix. One if it has defaults but no entries: it does not allow the pairs of the robot's own
/// matrix, so they are checked; MoveIt takes such a matrix too, except in a difference. One if it allows pairs that are
/// checked otherwise, because limits are wider than those of their proof (SrdfCollisions::unproven), as MoveIt's matrix
/// does.
std::vector<std::string> warningsOfMatrix(const RobotModel& robot, const AllowedCollisionMatrix& matrix);
}  // namespace gpu_planning_scene::core
