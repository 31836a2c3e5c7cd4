#pragma once

#include <string>

namespace gpu_planning_scene::core
{
/// Replaces control characters by spaces. Messages have one line, but names from files and requests may have line
/// breaks.
std::string onOneLine(std::string text);

/// Makes one line for a person to read. A name can be as long as its request, so the line has at most about 2000 bytes,
/// and each word at most about 300. In a longer line or word, the number of omitted bytes replaces the middle.
std::string shortLine(const std::string& text);
}  // namespace gpu_planning_scene::core
