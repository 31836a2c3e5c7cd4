#pragma once

#include <cstdint>

namespace gpu_planning_scene::core
{
/// The verdict that is proven for a pair or a state.
enum class Proof : std::uint8_t
{
  Apart,  ///< a pair; for a state: free
  Colliding,
  None
};
}  // namespace gpu_planning_scene::core
