#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "gpu_planning_scene/occupancy_map.h"

namespace gpu_planning_scene::core
{
/// A sensor, as an entry of the list `sensors` of MoveIt's sensors_3d.yaml.
struct SensorOptions
{
  std::string topic;              ///< of depth images or of clouds: the full name
  std::string camera_info_topic;  ///< full name; empty: the sensor sends clouds
  double min_range = 0.0;         ///< metres: near_clipping_plane_distance
  double max_range = 10.0;        ///< metres: far_clipping_plane_distance or max_range
  double padding = 0.03;          ///< metres: padding_offset
  double max_rate = 0.0;          ///< measurements per second: max_update_rate; 0: all
  /// Seconds without a used measurement, after which the octomap counts as out of date: max_silence; 0: never.
  double max_silence = 2.5;
  std::size_t step = 1;  ///< every step-th point of a cloud is used: point_subsample

  bool sendsImages() const { return !camera_info_topic.empty(); }
};

struct SensorsOptions
{
  std::vector<SensorOptions> sensors;  ///< ~sensors; empty: the node has no octomap of its own
  OccupancyMapOptions map;             ///< ~octomap_resolution, ~octomap_region, ~octomap_decay, ~limits/voxels
};

/// Throws Error that names the parameter and its valid values. `warnings` gets the keys of MoveIt that have no effect.
SensorsOptions sensorsFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own,
                                     const std::string& planning_frame, std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
