#pragma once

#include <cstddef>
#include <string>

namespace gpu_planning_scene::core
{
/// An amount of memory as a message names it, for example "512 MiB".
inline std::string megabytes(std::size_t bytes)
{
  return std::to_string(bytes >> 20) + " MiB";
}
}  // namespace gpu_planning_scene::core
