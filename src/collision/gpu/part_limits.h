#pragma once

#include <algorithm>
#include <cstddef>

#include "gpu/buffer.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
/// The most states of a part (the states of a batch that go to the device together): their poses fit a buffer texture
/// of `texture_bytes`, and a dispatch over them has at most MOST_LANES lanes, so that no index wraps in 32 bits.
/// `queries`: of the larger of the two lists of the broad phase.
inline std::size_t mostStatesOfPart(std::size_t texture_bytes, std::size_t robot_instances, std::size_t queries)
{
  constexpr std::size_t kPoseBytes = 12 * sizeof(float);
  constexpr std::size_t kMostTexels = (std::size_t{1} << 31) - 3;  // their index is an int
  const std::size_t instances = std::max<std::size_t>(1, robot_instances);
  const std::size_t by_poses =
      std::min(texture_bytes, kMostTexels * TexelBuffer::kTexelBytes) / (instances * kPoseBytes);
  const std::size_t by_lanes = std::size_t{MOST_LANES} / std::max(instances, queries);
  return std::max<std::size_t>(1, std::min(by_poses, by_lanes));
}
}  // namespace gpu_planning_scene::core
