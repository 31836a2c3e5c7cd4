#pragma once

#include <cstddef>

namespace gpu_planning_scene::core
{
/// Consecutive states of a batch.
struct StateRange
{
  std::size_t begin = 0;
  std::size_t count = 0;

  std::size_t end() const { return begin + count; }
};
}  // namespace gpu_planning_scene::core
