#pragma once

#include <cstddef>

#include "gpu/buffer.h"

namespace gpu_planning_scene::core
{
/// Where the poses of the robot's instances come from. Used on the context's thread.
class PoseSource
{
 public:
  virtual ~PoseSource() = default;

  /// Writes the poses in states [begin, begin + count) of a batch: three texels an instance
  /// (shaders/geometry/pose.glsl), instance by instance (poseIndex in shaders/problem/instance_lists.glsl). `poses` has
  /// room for them.
  virtual void write(std::size_t begin, std::size_t count, TexelBuffer& poses) = 0;
};
}  // namespace gpu_planning_scene::core
