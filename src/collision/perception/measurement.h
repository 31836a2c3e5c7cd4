#pragma once

#include <vector>

#include <Eigen/Core>

#include "collision/perception/depth_view.h"
#include "gpu_planning_scene/occupancy_map.h"

namespace gpu_planning_scene::core
{
/// A camera, and its frame relative to the sensor.
struct PlacedView
{
  Eigen::Matrix3d from_sensor;  // rotation
  DepthView depths;
};

/// Points, and the views that measured them.
struct Measurement
{
  std::vector<Eigen::Vector3d> points;  // in the sensor's frame, within the range
  std::vector<PlacedView> views;
  bool looks_everywhere = false;  // a cloud has no border, although there is no view where it has no points
};

// Both throw Error if an argument is not valid.

Measurement measurementOf(const DepthImage& image, const SensorView& view);
/// A cloud is seen by six cameras, through the faces of a cube around the sensor. Each pixel has the smallest depth of
/// its points.
Measurement measurementOf(const std::vector<Eigen::Vector3f>& points, const SensorView& view);
}  // namespace gpu_planning_scene::core
