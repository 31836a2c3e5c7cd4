#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace gpu_planning_scene
{
/// Messages are one line, and names in them, from files and requests, may have line breaks.
inline std::string onOneLine(std::string text)
{
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  return text;
}
}  // namespace gpu_planning_scene
