#pragma once

#include <string>
#include <vector>

#include "service/scene_store.h"

namespace gpu_planning_scene
{
/// Full states, row-major, from rows of values for the variables of these names; the others are as they are now.
/// `what`: the values' name in the request, for messages. Throws Error.
std::vector<double> requestedStates(const std::vector<std::string>& joint_names, const std::vector<double>& values,
                                    const std::string& what, const Snapshot& now);
}  // namespace gpu_planning_scene
