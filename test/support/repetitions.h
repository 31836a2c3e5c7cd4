#pragma once

namespace gpu_planning_scene::core
{
/// Number of repetitions of a randomised test: `few` in ./scripts/test, `many` in ./scripts/soak.
template <class Number>
constexpr Number repetitions([[maybe_unused]] Number few, [[maybe_unused]] Number many)
{
#ifdef GPS_SOAK
  return many;
#else
  return few;
#endif
}
}  // namespace gpu_planning_scene::core
