#pragma once

#include <string>

namespace gpu_planning_scene::core
{
/// Messages are one line, and names in them, from files and requests, may have line breaks.
std::string onOneLine(std::string text);

/// The same, and no longer than what a person reads, about 2000 bytes, with words of about 300: names may be as long as
/// the request that they are in. The middle of what is too long is left out, and counted.
std::string shortLine(const std::string& text);
}  // namespace gpu_planning_scene::core
