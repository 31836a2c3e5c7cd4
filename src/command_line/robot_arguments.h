#pragma once

#include <memory>
#include <string>
#include <vector>

#include "command_line/command_line.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The tools' options for the robot (--urdf, --srdf, --package, --unbounded-translation, --solid) and for the device
/// (--device,
/// --traversal, --max-batch, --tolerance).
std::vector<Option> robotOptions();
/// --package alone, which is also one of robotOptions().
Option packageOption();
std::vector<Option> deviceOptions();

/// Resolves packages by the NAME=DIR of each --package, then by ROS_PACKAGE_PATH.
PackageResolver packagesFrom(const CommandLine& arguments);
std::shared_ptr<const RobotModel> robotFrom(const CommandLine& arguments, std::vector<std::string>* warnings);
BatchCheckerOptions checkerOptionsFrom(const CommandLine& arguments);

/// Prints the warnings to stderr, one per line.
void printWarnings(const std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
