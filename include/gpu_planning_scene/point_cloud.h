#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
struct PointCloudOptions
{
  double voxel = 0.05;                ///< metres: the edge of a cube
  double robot_padding = 0.03;        ///< metres: cubes no further than this from the robot are its own
  double most_distance = 10.0;        ///< metres: points further from the sensor are left out
  std::size_t most_voxels = 200'000;  ///< more are refused
};

/// Turns clouds of points into one world object: a cube for each voxel of the planning frame's grid that has a point in
/// it. A cube holds its points, so what is free of the object is free of every point; what is nearer to a point than
/// the diagonal of a voxel may be called colliding. One caller at a time.
class PointCloudFilter
{
 public:
  /// Throws Error for an option that is not finite, negative, or without a meaning as 0.
  explicit PointCloudFilter(const PointCloudOptions& options);
  ~PointCloudFilter();

  /// `points`: in the sensor's frame, which is at `sensor` in the planning frame. Those that are not finite, as sensors
  /// mark what they did not see, are left out. So are cubes at the robot of `scene`, and at what it carries, in
  /// `state`: by the exact test, no further than the padding for it; the links' own padding does not count. No shapes:
  /// no cubes are left. Throws Error: a state or pose that is not finite, more cubes than there may be.
  WorldObject objectOf(const std::string& id, const std::vector<Eigen::Vector3f>& points,
                       const Eigen::Isometry3d& sensor, const PlanningScene& scene, const double* state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
