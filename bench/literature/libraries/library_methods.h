#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core::literature
{
/// A line for each method of libraryMethods() that this build has, but that cannot be used here: its name and the
/// reason.
std::vector<std::string> missingLibraryMethods();
}  // namespace gpu_planning_scene::core::literature
