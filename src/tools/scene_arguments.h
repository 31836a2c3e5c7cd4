#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"
#include "tools/command_line.h"

namespace gpu_planning_scene::core
{
/// --scene and --object.
std::vector<Option> sceneOptions();

/// What those ask for, with the robot of robotOptions. Throws UsageError or Error.
PlanningScene sceneFrom(const CommandLine& arguments, std::vector<std::string>* warnings);

/// A mesh file as an object: "ID=FILE[,x,y,z[,qx,qy,qz,qw]]". Throws UsageError.
WorldObject objectFrom(const std::string& text);

/// "1,2.5,-3": exactly `count` finite numbers. Throws UsageError that names the option.
std::vector<double> numbersFrom(const std::string& option, const std::string& text, std::size_t count);
}  // namespace gpu_planning_scene::core
