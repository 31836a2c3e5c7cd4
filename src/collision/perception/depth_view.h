#pragma once

#include <vector>

#include <Eigen/Core>

#include "gpu_planning_scene/occupancy_map.h"

namespace gpu_planning_scene::core
{
/// The depths that a pinhole camera has measured, and the smallest depth of each square of 2, 4, 8, ... pixels. So a
/// few reads tell whether the camera sees through a voxel: the hierarchical z-buffer of N. Greene, M. Kass, G. Miller:
/// Hierarchical Z-buffer visibility. SIGGRAPH 1993.
class DepthView
{
 public:
  /// `depths`: metres along the optical axis, row by row. Infinity: no ray. 0: a ray that ends in front of everything.
  DepthView(const PinholeCamera& camera, std::vector<float> depths);

  /// Whether a point is in front of the camera and in its image.
  bool shows(const Eigen::Vector3d& point) const;

  /// Whether the camera sees what is behind a ball. `center`, `radius`: metres, in the camera's frame (x to the right,
  /// y down, z forward). True if the image shows the ball's center, a ray is measured near the ball, and every measured
  /// ray near it ends behind it. "Near" is the ball's bounding rectangle in the image, enlarged by a pixel. So a ball
  /// beside the silhouette of a nearer surface is not seen through, nor is a ball on a surface that the camera sees at
  /// a grazing angle.
  bool seesBehind(const Eigen::Vector3d& center, double radius) const;

 private:
  struct Level
  {
    int width;
    int height;
    std::vector<float> depths;
  };

  PinholeCamera camera_;
  std::vector<Level> levels_;
};
}  // namespace gpu_planning_scene::core
