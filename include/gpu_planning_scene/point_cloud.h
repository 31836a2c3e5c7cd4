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
  double voxel = 0.05;  ///< metres: edge length of a cube
  /// Metres: cubes up to this distance from the robot count as the robot's own points and are left out.
  double robot_padding = 0.03;
  double max_distance = 10.0;        ///< metres: points farther from the sensor are left out
  std::size_t max_voxels = 200'000;  ///< a cloud with more is refused
};

/// Turns point clouds into one world object. The space around the planning frame's origin is divided into voxels; the
/// object has a cube for each voxel that contains a point. So a body that does not collide with the object touches no
/// point. A body may be reported as colliding if a point is nearer than the diagonal of a voxel. Not thread-safe.
class PointCloudFilter
{
 public:
  /// Throws Error if an option is negative or not finite, or if `voxel` or `max_distance` is 0.
  explicit PointCloudFilter(const PointCloudOptions& options);
  ~PointCloudFilter();

  /// `points`: metres, in the sensor's frame. `sensor`: the pose of that frame in the planning frame. `state`: one
  /// value per variable. Points that are not finite are left out, because sensors mark missing measurements with them.
  /// Cubes within `robot_padding` of the robot of `scene` in `state`, or of its attached objects, are left out too. The
  /// exact checker decides this; the paddings of the links do not count. The object has no shapes if no cube is left.
  /// Throws Error if `state` or `sensor` is not valid, if the cloud fills more than `max_voxels` voxels, or if a point
  /// is too far from the origin of the planning frame for the size of the voxels.
  WorldObject objectOf(const std::string& id, const std::vector<Eigen::Vector3f>& points,
                       const Eigen::Isometry3d& sensor, const PlanningScene& scene, const double* state);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
