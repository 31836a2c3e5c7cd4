#pragma once

#include <string>
#include <vector>

#include "command_line/command_line.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// --scene and --object.
std::vector<Option> sceneOptions();

/// The scene of --scene and --object, with the robot of robotOptions(). Throws UsageError or Error.
PlanningScene sceneFrom(const CommandLine& arguments, std::vector<std::string>* warnings);

/// A mesh file as an object. `text`: "ID=FILE[,x,y,z[,qx,qy,qz,qw]]", where FILE is a path, package:// or file://.
/// Throws UsageError for a wrong text, and Error for a file that cannot be read.
WorldObject objectFrom(const std::string& text, const PackageResolver& packages);

/// Reads exactly `count` finite numbers from a text like "1,2.5,-3". Throws UsageError, which names the option.
std::vector<double> numbersFrom(const std::string& option, const std::string& text, std::size_t count);
}  // namespace gpu_planning_scene::core
