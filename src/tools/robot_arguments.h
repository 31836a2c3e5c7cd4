#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/robot_model.h"
#include "tools/command_line.h"

namespace gpu_planning_scene::core
{
/// What every tool asks of a robot (--urdf, --srdf, --package, --unbounded-translation) and of a device (--device,
/// --traversal, --max-batch, --tolerance).
std::vector<Option> robotOptions();
std::vector<Option> deviceOptions();

/// NAME=DIR of each --package.
PackageResolver packagesFrom(const CommandLine& arguments);
std::shared_ptr<const RobotModel> robotFrom(const CommandLine& arguments, std::vector<std::string>* warnings);
BatchCheckerOptions checkerOptionsFrom(const CommandLine& arguments);

/// On stderr, a line each.
void printWarnings(const std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
