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

  std::vector<std::uint64_t> voxelsOf(const std::vector<Eigen::Vector3f>& points, const Isometry3d& sensor) const;

  const PointCloudOptions options;
  const VoxelGrid grid;
  BodyFilter bodies;
};

/// The keys of the occupied voxels, in ascending order, each once.
std::vector<std::uint64_t> PointCloudFilter::Impl::voxelsOf(const std::vector<Eigen::Vector3f>& points,
                                                            const Isometry3d& sensor) const
{
  VoxelKeys keys;
  for (const Eigen::Vector3f& point : points)
  {
    const Vector3d local = point.cast<double>();
    if (local.allFinite() && local.norm() <= options.max_distance)
      keys.add(grid.keyOf(sensor * local));
  }
  return keys.take();
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
  const std::vector<std::uint64_t> voxels = impl_->voxelsOf(points, nearestRigid(sensor, "the sensor's pose"));
  if (voxels.size() > impl_->options.max_voxels)
    throw Error("the cloud fills " + std::to_string(voxels.size()) + " voxels, but at most " +
                std::to_string(impl_->options.max_voxels) + " are allowed; use larger voxels or a shorter range");
  std::vector<Vector3d> centres;
  centres.reserve(voxels.size());
  for (const std::uint64_t voxel : voxels)
    centres.push_back(impl_->grid.centreOf(voxel));
  removeFlagged(centres, impl_->bodies.near(impl_->grid, centres, scene, state, impl_->options.robot_padding, {}));
  WorldObject object;
  object.id = id;
  object.shapes = impl_->grid.cubesAt(centres);
  return object;
}
}  // namespace gpu_planning_scene::core
