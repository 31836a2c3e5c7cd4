#pragma once

#include <string>

namespace gpu_planning_scene::core
{
/// Replaces control characters by spaces. Messages have one line, but names from files and requests may have line
/// breaks.
std::string onOneLine(std::string text);

/// Makes one line of at most about 2000 bytes, with words of about 300, for a person to read: a name can be as long as
/// its request. In a longer text, the number of omitted bytes replaces the middle.
std::string shortLine(const std::string& text);
}  // namespace gpu_planning_scene::core
