#pragma once

#include <cstddef>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <Eigen/Core>

#include "gpu_planning_scene/occupancy_map.h"

namespace gpu_planning_scene::core
{
/// Every `step`-th point of a cloud, from its FLOAT32 fields x, y and z. Throws Error if a field is missing, if the
/// cloud is big-endian, or if its sizes do not fit together.
std::vector<Eigen::Vector3f> pointsOf(const sensor_msgs::PointCloud2& message, std::size_t step = 1);

/// The camera of a rectified image: its projection matrix P, or K if P is not set. Throws Error for a region of
/// interest or binning.
PinholeCamera cameraOf(const sensor_msgs::CameraInfo& info);

/// A depth image of a camera, with the encodings of REP 118: 32FC1 (metres) or 16UC1 (millimetres), also mono16. Throws
/// Error for another encoding or byte order, and if the sizes of the image do not fit together or differ from those of
/// the camera.
DepthImage depthImageOf(const sensor_msgs::Image& message, const PinholeCamera& camera);
}  // namespace gpu_planning_scene::core
