#pragma once

#include <cstddef>
#include <limits>

#include "gpu/buffer.h"

namespace gpu_planning_scene::core
{
/// A source of the poses of the robot's instances. Used on the context's thread.
class PoseSource
{
 public:
  virtual ~PoseSource() = default;

  /// Writes the poses for the states [begin, begin + count) of a batch. A pose takes POSE_TEXELS
  /// texels (shaders/geometry/pose.glsl). The poses are ordered by instance, then by state (poseIndex in
  /// shaders/problem/instance_lists.glsl). `poses` must be large enough.
  virtual void write(std::size_t begin, std::size_t count, TexelBuffer& poses) = 0;

  /// The most states that `write` takes at once.
  virtual std::size_t maxStates() const { return std::numeric_limits<std::size_t>::max(); }

  /// The number of variables of a state, if `write` leaves the states bound to UNIT_STATES; otherwise 0.
  virtual std::size_t boundVariables() const { return 0; }
};
}  // namespace gpu_planning_scene::core
