#pragma once

#include <string>
#include <vector>

#include "tools/acm_generator.h"

namespace gpu_planning_scene::core
{
/// Writes an SRDF with the matrix and a comment that explains it, and with groups (chain_groups.h) if `srdf` has none.
/// `srdf`: the XML of the robot's SRDF, or empty. All of it is kept except earlier generated entries of the matrix.
std::string srdfWith(const GeneratedMatrix& matrix, const RobotModel& robot, const GeneratorOptions& options,
                     const std::string& srdf);

/// The names of the planning groups in an SRDF that srdfWith has written.
std::vector<std::string> groupNamesOf(const std::string& srdf);

/// The name of the robot in an SRDF; empty if the text is not XML with the root <robot>.
std::string robotNameOf(const std::string& srdf);
}  // namespace gpu_planning_scene::core
