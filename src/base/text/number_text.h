#pragma once

#include <string>

namespace gpu_planning_scene::core
{
/// A text from which the same finite number is read back, for example "2.50000000000000000e-01". It does not depend on
/// the locale of the process: some programs with a window write a decimal comma.
std::string exactText(double value);

/// A text for people, with nine significant digits: "0.25". It does not depend on the locale either.
std::string numberText(double value);
}  // namespace gpu_planning_scene::core
