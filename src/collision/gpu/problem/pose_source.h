#pragma once

#include <cstddef>
#include <limits>

#include "collision/gpu/traversal/gpu_traversal.h"
#include "gpu/buffer.h"

namespace gpu_planning_scene::core
{
/// A source of the poses of the robot's instances. Used on the context's thread.
class PoseSource
{
 public:
  virtual ~PoseSource() = default;

  /// Begins a part: the states [begin, begin + count) of a batch.
  virtual void begin(std::size_t begin, std::size_t count) = 0;

  /// Writes the poses for the states of the part. A pose takes POSE_TEXELS texels (shaders/geometry/pose.glsl). The
  /// poses are ordered by instance, then by state (poseIndex in shaders/problem/instance_lists.glsl). `poses` must be
  /// large enough.
  virtual void place(TexelBuffer& poses) = 0;

  /// The same, at least for the states of lists.open_states.
  virtual void placeOpenStates(TexelBuffer& poses, const BatchLists& /*lists*/) { place(poses); }

  /// The most states of a part.
  virtual std::size_t maxStates() const { return std::numeric_limits<std::size_t>::max(); }

  /// The number of variables of a state, if `begin` binds the states to UNIT_STATES; otherwise 0.
  virtual std::size_t boundVariables() const { return 0; }
};
}  // namespace gpu_planning_scene::core
