#pragma once

#include <string>

#include "tools/acm_generator.h"

namespace gpu_planning_scene::core
{
/// An SRDF with the matrix and a comment on how it came about. `srdf`: the XML of the robot's SRDF, all of which is
/// kept but earlier generated entries; empty if there is none.
std::string srdfWith(const GeneratedMatrix& matrix, const RobotModel& robot, const SamplingOptions& options,
                     const std::string& srdf);
}  // namespace gpu_planning_scene::core
