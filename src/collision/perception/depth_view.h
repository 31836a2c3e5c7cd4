#pragma once

#include <vector>

#include <Eigen/Core>

#include "gpu_planning_scene/occupancy_map.h"

namespace gpu_planning_scene::core
{
/// A voxel in a camera's frame (x to the right, y down, z forward). All lengths are metres.
struct VoxelInView
{
  Eigen::Vector3d centre;
  Eigen::Vector3d extent;  ///< half lengths of its bounding box along the camera's axes
  double inner_radius;     ///< of the ball inside it
};

/// The depths that a pinhole camera has measured, and the smallest depth of each square of 2, 4, 8, ... pixels. So a
/// few reads tell whether the camera sees through a voxel: the hierarchical z-buffer of N. Greene, M. Kass, G. Miller:
/// Hierarchical Z-buffer visibility. SIGGRAPH 1993.
class DepthView
{
 public:
  /// `depths`: metres along the optical axis, row by row. Infinity: there is no ray in this pixel. 0: the ray ends
  /// before all bodies. `has_gaps`: pixels without a ray are places that the sensor did not look at, as between the
  /// rows of a laser scanner.
  DepthView(const PinholeCamera& camera, std::vector<float> depths, bool has_gaps = false);

  /// Whether a point is in front of the camera and in its image.
  bool shows(const Eigen::Vector3d& point) const;

  /// Whether a voxel, with a pixel around it, is in front of the camera and in its image. See seesBehind().
  bool showsAll(const VoxelInView& voxel) const;

  /// Whether the camera sees what is behind a voxel. True if the image shows its centre, at least one ray is measured
  /// near the voxel, and every measured ray near it ends behind the ball around it. "Near" is the bounding rectangle of
  /// the voxel's box in the image, enlarged by a pixel. So the camera does not see behind a voxel at the edge of a
  /// nearer surface, nor through a surface at a grazing angle. If the rays have gaps, at least one ray must also pass
  /// through the voxel.
  bool seesBehind(const VoxelInView& voxel) const;

 private:
  struct Level
  {
    int width;
    int height;
    std::vector<float> depths;
  };

  /// Both ends count.
  struct PixelRange
  {
    int first;
    int last;
  };
  /// A pixel of a level: a square of pixels of the image.
  struct Square
  {
    int level;
    int x;
    int y;
  };

  /// The part of an interval that is in the image.
  static PixelRange within(double first, double last, int size);
  float smallestOf(const Square& square) const;
  bool endBehind(const Square& square, const PixelRange& columns, const PixelRange& rows, double far) const;
  bool passesThrough(const Eigen::Vector3d& centre, double radius) const;

  PinholeCamera camera_;
  bool has_gaps_;
  std::vector<Level> levels_;
};
}  // namespace gpu_planning_scene::core
