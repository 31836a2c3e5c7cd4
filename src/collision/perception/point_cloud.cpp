#include "gpu_planning_scene/point_cloud.h"

#include <cmath>
#include <utility>

#include "collision/perception/body_filter.h"
#include "collision/perception/voxel_grid.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"
#include "model/rigid_pose.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

void refuseOption(bool fits, double value, const char* what)
{
  if (!std::isfinite(value) || !fits)
    throw Error(std::string("point clouds: ") + what + " is " + std::to_string(value) +
                "; it must be a finite number of metres" + (value == 0.0 ? " above 0" : ", not negative"));
}
}  // namespace

struct PointCloudFilter::Impl
{
  explicit Impl(const PointCloudOptions& given) : options(given), grid(given.voxel) {}

  std::vector<Vector3d> centresOf(const std::vector<Eigen::Vector3f>& points, const Isometry3d& sensor) const;

  const PointCloudOptions options;
  const VoxelGrid grid;
  BodyFilter bodies;
};

/// The centres of the occupied voxels, in ascending order of their keys, each once.
std::vector<Vector3d> PointCloudFilter::Impl::centresOf(const std::vector<Eigen::Vector3f>& points,
                                                        const Isometry3d& sensor) const
{
  VoxelCounts filled;
  for (const Eigen::Vector3f& point : points)
  {
    const Vector3d local = point.cast<double>();
    if (local.allFinite() && local.norm() <= options.max_distance)
      filled.add(grid.keyOf(sensor * local));
  }
  std::vector<Vector3d> centres;
  for (const FilledVoxel& voxel : filled.take())
    centres.push_back(grid.centreOf(voxel.key));
  return centres;
}

PointCloudFilter::PointCloudFilter(const PointCloudOptions& options)
{
  refuseOption(options.voxel > 0.0, options.voxel, "the voxel size");
  refuseOption(options.robot_padding >= 0.0, options.robot_padding, "the robot's padding");
  refuseOption(options.max_distance > 0.0, options.max_distance, "the range");
  impl_ = std::make_unique<Impl>(options);
}

PointCloudFilter::~PointCloudFilter() = default;

WorldObject PointCloudFilter::objectOf(const std::string& id, const std::vector<Eigen::Vector3f>& points,
                                       const Isometry3d& sensor, const PlanningScene& scene, const double* state)
{
  validateStates(*scene.robot, state, 1);
  std::vector<Vector3d> centres = impl_->centresOf(points, nearestRigid(sensor, "the sensor's pose"));
  if (centres.size() > impl_->options.max_voxels)
    throw Error("the cloud fills " + std::to_string(centres.size()) + " voxels, but at most " +
                std::to_string(impl_->options.max_voxels) + " are allowed; use larger voxels or a shorter range");
  removeFlagged(centres, impl_->bodies.near(impl_->grid, centres, scene, state, impl_->options.robot_padding, {}));
  WorldObject object;
  object.id = id;
  object.shapes = impl_->grid.cubesAt(centres);
  return object;
}
}  // namespace gpu_planning_scene::core
