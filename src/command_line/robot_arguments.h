#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "command_line/command_line.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The tools' options for the robot (--urdf, --srdf, --package, --planning, --unbounded-translation, --solid) and for
/// the device (--device, --traversal, --device-only, --max-batch).
std::vector<Option> robotOptions();
/// --package alone, which is also one of robotOptions().
Option packageOption();
std::vector<Option> deviceOptions();

/// The NAME=DIR of each --package. Throws UsageError for any other text.
std::map<std::string, std::string> packageFoldersFrom(const CommandLine& arguments);
/// Resolves packages by the NAME=DIR of each --package, then by ROS_PACKAGE_PATH.
PackageResolver packagesFrom(const CommandLine& arguments);
std::shared_ptr<const RobotModel> robotFrom(const CommandLine& arguments, std::vector<std::string>* warnings);
/// The same with the SRDF `srdf` in place of --srdf; empty: none.
std::shared_ptr<const RobotModel> robotFrom(const CommandLine& arguments, const std::string& srdf,
                                            std::vector<std::string>* warnings);
BatchCheckerOptions checkerOptionsFrom(const CommandLine& arguments);

/// Prints the warnings to stderr, one per line.
void printWarnings(const std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
