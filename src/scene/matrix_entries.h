#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/allowed_collision_matrix.h"

namespace gpu_planning_scene::core
{
/// Removes the entries of a removed object from the matrix, and returns warnings: one for each body that the object was
/// forbidden to touch, and that a new object of this name may touch.
std::vector<std::string> removeEntriesOfObject(AllowedCollisionMatrix& matrix, const std::string& id);
}  // namespace gpu_planning_scene::core
