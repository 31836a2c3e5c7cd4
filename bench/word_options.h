#pragma once

#include <string>
#include <vector>

#include "command_line/command_line.h"

namespace gpu_planning_scene::core
{
/// The words of an option, which are separated by commas. Without the option: all known words. Throws UsageError for a
/// word that is not in `known`, and for an empty list.
std::vector<std::string> chosenWords(const CommandLine& arguments, const std::string& option,
                                     const std::vector<std::string>& known);

/// The parts of a text between commas, without empty ones.
std::vector<std::string> splitAtCommas(const std::string& text);
}  // namespace gpu_planning_scene::core
