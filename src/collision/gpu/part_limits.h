#pragma once

#include <algorithm>
#include <cstddef>

#include "gpu/buffer.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
/// The largest number of states in a part (states of a batch that go to the device together). Their poses must fit into
/// a buffer texture of `texture_bytes`. A dispatch over them must have at most MAX_INVOCATIONS invocations, so that no
/// index wraps in 32 bits. `queries`: length of the longer list of broad-phase queries.
inline std::size_t maxStatesOfPart(std::size_t texture_bytes, std::size_t robot_instances, std::size_t queries)
{
  constexpr std::size_t kPoseBytes = POSE_TEXELS * TexelBuffer::kTexelBytes;
  constexpr std::size_t kMaxTexels = (std::size_t{1} << 31) - 3;  // texel indices are int
  const std::size_t instances = std::max<std::size_t>(1, robot_instances);
  const std::size_t by_poses =
      std::min(texture_bytes, kMaxTexels * TexelBuffer::kTexelBytes) / (instances * kPoseBytes);
  const std::size_t by_invocations = std::size_t{MAX_INVOCATIONS} / std::max(instances, queries);
  return std::max<std::size_t>(1, std::min(by_poses, by_invocations));
}
}  // namespace gpu_planning_scene::core
