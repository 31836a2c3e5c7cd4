#pragma once

#include <cstdint>
#include <random>
#include <string>

#include <Eigen/Geometry>

#include "gpu_planning_scene/occupancy_map.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Errors of a depth camera.
struct DepthNoise
{
  double deviation = 0.0;  ///< metres at a depth of 1 m; it grows with the square of the depth
  double dropouts = 0.0;   ///< the share of single pixels that are not measured
};

/// The depths that a camera measures in a scene: of the robot in `state`, its attached objects, and the objects of the
/// world, without half-spaces. Pixels without a surface are infinite. `camera_pose`: in the planning frame, x to the
/// right, y down, z forward.
DepthImage depthImageOf(const PlanningScene& scene, const double* state, const PinholeCamera& camera,
                        const Eigen::Isometry3d& camera_pose);

/// An object that is a box of this size (metres).
WorldObject boxAt(const std::string& id, const Eigen::Vector3d& centre, const Eigen::Vector3d& size);

/// Metres: the distance of a point from the surface of an object of boxAt().
double distanceFromSurface(const WorldObject& box, const Eigen::Vector3d& point);

/// The point of a pixel's depth, in the camera's frame.
Eigen::Vector3d pointOf(const DepthImage& image, int x, int y);

void addNoise(DepthImage& image, const DepthNoise& noise, std::mt19937_64& generator);

/// The pose of a camera at `eye` that looks at `target`, with the planning frame's z axis up in the image.
Eigen::Isometry3d cameraPose(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);
}  // namespace gpu_planning_scene::core
