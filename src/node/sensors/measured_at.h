#pragma once

#include <vector>

#include <std_msgs/Header.h>
#include <Eigen/Geometry>

#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// The robot and the sensor at the time of a measurement, in the newest scene.
struct MeasuredAt
{
  Snapshot now;
  std::vector<double> state;  ///< one value per variable, of the header's time
  Eigen::Isometry3d sensor;   ///< pose of the header's frame in the planning frame
};

/// Throws Error if the robot's state is not known yet, and the errors of `lookup` and SceneStore::stateAt.
MeasuredAt measuredAt(const std_msgs::Header& header, const SceneStore& store, const SceneStore::Lookup& lookup);
}  // namespace gpu_planning_scene::core
