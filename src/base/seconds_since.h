#pragma once

#include <chrono>

namespace gpu_planning_scene::core
{
inline double secondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
}  // namespace gpu_planning_scene::core
