#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/scene_change.h"

namespace gpu_planning_scene::core
{
/// Finds the frames that the scene does not have, for example those of tf.
struct OtherFrames
{
  /// The pose of a frame in the planning frame. Throws Error if it is not found.
  std::function<Eigen::Isometry3d(const StampedFrame& frame)> pose;
  /// The frames on which a frame hangs: its parent, the parent of its parent, and so on. Without this function, no
  /// frame hangs on another one.
  std::function<std::vector<std::string>(const std::string& frame)> parents = {};
};
}  // namespace gpu_planning_scene::core
