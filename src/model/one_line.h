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

/// The same, and no longer than what a person reads: names may be long too.
inline std::string shortLine(const std::string& text)
{
  constexpr std::size_t kLongest = 2000;
  return onOneLine(text.size() <= kLongest ? text : text.substr(0, kLongest) + " ...");
}
}  // namespace gpu_planning_scene
