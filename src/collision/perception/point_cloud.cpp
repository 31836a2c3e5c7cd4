#include "gpu_planning_scene/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "collision/bounds/problem_maker.h"
#include "collision/exact/forest_cache.h"
#include "collision/geometry/primitive_solid.h"
#include "collision/geometry/shape_bounds.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"
#include "model/rigid_pose.h"

// Sorts the points into voxels, makes a cube for each occupied voxel, and removes the cubes that touch the robot. The
// grid of voxels is that of PCL's VoxelGrid filter (R. B. Rusu, S. Cousins: 3D is here: Point Cloud Library. ICRA
// 2011).
namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// A key of 63 bits holds the three indices of a voxel, with 21 bits each.
constexpr int kBits = 21;
constexpr std::int64_t kMaxIndex = (std::int64_t{1} << (kBits - 1)) - 1;

// The culling boxes are enlarged by this margin, which exceeds their rounding error.
constexpr double kCubeMargin = 1e-6;  // metres

std::uint64_t keyOf(const Vector3d& index)
{
  std::uint64_t key = 0;
  for (const int axis : {2, 1, 0})
    key = key << kBits | static_cast<std::uint64_t>(static_cast<std::int64_t>(index[axis]) + kMaxIndex);
  return key;
}

Vector3d centerOfVoxel(std::uint64_t key, double size)
{
  Vector3d center;
  for (const int axis : {0, 1, 2})
  {
    const auto index = static_cast<std::int64_t>(key >> (axis * kBits) & ((std::uint64_t{1} << kBits) - 1)) - kMaxIndex;
    center[axis] = (static_cast<double>(index) + 0.5) * size;
  }
  return center;
}

AlignedBox3d boundsAt(const AlignedBox3d& local, const Isometry3d& pose, double margin)
{
  const Vector3d center = pose * local.center();
  const Vector3d half = (0.5 * (pose.linear().cwiseAbs() * local.sizes())).array() + margin;
  return {center - half, center + half};
}

void refuseOption(bool fits, double value, const char* what)
{
  if (!std::isfinite(value) || !fits)
    throw Error(std::string("point clouds: ") + what + " is " + std::to_string(value) +
                "; it must be a finite number of metres" + (value == 0.0 ? " above 0" : ", not negative"));
}
}  // namespace

struct PointCloudFilter::Impl
{
  std::vector<std::uint64_t> voxelsOf(const std::vector<Eigen::Vector3f>& points, const Isometry3d& sensor) const;
  void removeRobot(const PlanningScene& scene, const double* state, std::vector<PlacedShape>& cubes);
  std::vector<std::size_t> cubesNear(const PlanningScene& scene, const std::vector<Isometry3d>& link_poses,
                                     const std::vector<PlacedShape>& cubes) const;

  PointCloudOptions options;
  ProblemMaker maker{optionsWithAllPairs()};  // `maker` and `trees` keep the robot's trees from cloud to cloud
  ForestCache trees;
};

/// The keys of the occupied voxels, in ascending order, each once.
std::vector<std::uint64_t> PointCloudFilter::Impl::voxelsOf(const std::vector<Eigen::Vector3f>& points,
                                                            const Isometry3d& sensor) const
{
  std::vector<std::uint64_t> keys;
  keys.reserve(points.size());
  for (const Eigen::Vector3f& point : points)
  {
    const Vector3d local = point.cast<double>();
    if (!local.allFinite() || local.norm() > options.max_distance)
      continue;
    const Vector3d index = ((sensor * local) / options.voxel).array().floor();
    if (index.cwiseAbs().maxCoeff() > static_cast<double>(kMaxIndex))
      throw Error("a point of the cloud is more than " + std::to_string(kMaxIndex) +
                  " voxels from the planning frame's origin; use larger voxels or a nearer planning frame");
    keys.push_back(keyOf(index));
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

/// The indices of the cubes whose boxes are within the padding of the bounding box of a shape of the robot.
std::vector<std::size_t> PointCloudFilter::Impl::cubesNear(const PlanningScene& scene,
                                                           const std::vector<Isometry3d>& link_poses,
                                                           const std::vector<PlacedShape>& cubes) const
{
  const double margin = 0.5 * options.voxel + options.robot_padding + kCubeMargin;
  std::vector<AlignedBox3d> boxes;
  for (const RobotBody& body : robotBodies(scene))
    for (const PlacedShape& placed : *body.shapes)
      boxes.push_back(boundsAt(boundsOf(placed.shape),
                               link_poses[static_cast<std::size_t>(body.link)] * rigidProduct(body.pose, placed.pose),
                               margin));
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < cubes.size(); ++i)
  {
    const Vector3d center = cubes[i].pose.translation();
    if (std::any_of(boxes.begin(), boxes.end(), [&](const AlignedBox3d& box) { return box.contains(center); }))
      near.push_back(i);
  }
  return near;
}

void PointCloudFilter::Impl::removeRobot(const PlanningScene& scene, const double* state,
                                         std::vector<PlacedShape>& cubes)
{
  std::vector<Isometry3d> link_poses(scene.robot->links().size());
  scene.robot->linkPoses(state, link_poses.data());
  const std::vector<std::size_t> near = cubesNear(scene, link_poses, cubes);
  if (near.empty())
    return;
  // A scene with the robot and its attached objects, padded by options.robot_padding, and with the near cubes only.
  PlanningScene among(scene.robot);
  among.allowed_collisions = {};
  among.link_padding.assign(link_poses.size(), options.robot_padding);
  among.attached = scene.attached;
  for (AttachedObject& attached : among.attached)
    attached.padding = 0.0;
  among.objects.push_back({"cloud", Isometry3d::Identity(), {}, 0.0});
  // A unique name: it is longer than the names of all links and attached objects.
  for (const Link& link : scene.robot->links())
    among.objects[0].id += link.name;
  for (const AttachedObject& attached : among.attached)
    among.objects[0].id += attached.object.id;
  for (const std::size_t cube : near)
    among.objects[0].shapes.push_back(cubes[cube]);
  auto problem = maker.make(among, "", nullptr);
  problem.self_pairs.clear();
  const std::size_t robots = problem.robot.size();
  const auto exact = trees.exactCheckerOf(std::make_shared<const CollisionProblem>(std::move(problem)));
  ExactChecker::Scratch scratch;
  std::vector<bool> is_robot(cubes.size(), false);
  for (const auto& pair : exact->collidingInstances(link_poses.data(), scratch))
    is_robot[near[pair[1] - robots]] = true;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cubes.size(); ++i)
    if (!is_robot[i])
      cubes[kept++] = cubes[i];
  cubes.resize(kept);
}

PointCloudFilter::PointCloudFilter(const PointCloudOptions& options) : impl_(std::make_unique<Impl>())
{
  refuseOption(options.voxel > 0.0, options.voxel, "the voxel size");
  refuseOption(options.robot_padding >= 0.0, options.robot_padding, "the robot's padding");
  refuseOption(options.max_distance > 0.0, options.max_distance, "the range");
  impl_->options = options;
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
  WorldObject object;
  object.id = id;
  object.shapes.reserve(voxels.size());
  const Shape cube = Box{Vector3d::Constant(impl_->options.voxel)};
  for (const std::uint64_t voxel : voxels)
    object.shapes.push_back({cube, Isometry3d(Eigen::Translation3d(centerOfVoxel(voxel, impl_->options.voxel)))});
  impl_->removeRobot(scene, state, object.shapes);
  return object;
}
}  // namespace gpu_planning_scene::core
