#include "collision/perception/body_filter.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "collision/geometry/primitive_solid.h"
#include "collision/geometry/shape_bounds.h"
#include "gpu_planning_scene/error.h"
#include "model/rigid_pose.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// The culling boxes are enlarged by this margin, which exceeds their rounding error.
constexpr double kCubeMargin = 1e-6;  // metres

AlignedBox3d boundsAt(const AlignedBox3d& local, const Isometry3d& pose, double margin)
{
  const Vector3d centre = pose * local.center();
  const Vector3d half = (0.5 * (pose.linear().cwiseAbs() * local.sizes())).array() + margin;
  return {centre - half, centre + half};
}

/// The robot and its attached objects with this padding. The named objects of the world are attached to the first link,
/// where they are, behind the scene's own attached objects.
PlanningScene paddedBodies(const PlanningScene& scene, const std::vector<Isometry3d>& link_poses, double padding,
                           const std::set<std::string>& objects)
{
  PlanningScene bodies(scene.robot);
  bodies.allowed_collisions = {};
  bodies.link_padding.assign(link_poses.size(), padding);
  bodies.attached = scene.attached;
  for (const WorldObject& object : scene.objects)
  {
    if (objects.count(object.id) == 0)
      continue;
    for (const PlacedShape& placed : object.shapes)
      if (std::holds_alternative<HalfSpace>(placed.shape))
        throw Error("object '" + object.id + "' has a half-space, so measured points on it cannot be left out");
    AttachedObject& attached = bodies.attached.emplace_back();
    attached.object = object;
    attached.object.pose = rigidProduct(link_poses[0].inverse(), object.pose);
    attached.link = 0;
  }
  for (AttachedObject& attached : bodies.attached)
    attached.padding = 0.0;
  return bodies;
}

/// The indices of the cubes whose boxes are within the padding of the bounding box of a shape of the robot.
std::vector<std::size_t> cubesNear(const PlanningScene& bodies, const std::vector<Isometry3d>& link_poses,
                                   double margin, const std::vector<Vector3d>& centres)
{
  std::vector<AlignedBox3d> boxes;
  AlignedBox3d all;
  for (const RobotBody& body : robotBodies(bodies))
    for (const PlacedShape& placed : *body.shapes)
    {
      boxes.push_back(boundsAt(boundsOf(placed.shape),
                               link_poses[static_cast<std::size_t>(body.link)] * rigidProduct(body.pose, placed.pose),
                               margin));
      all.extend(boxes.back());
    }
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < centres.size(); ++i)
    if (all.contains(centres[i]) &&
        std::any_of(boxes.begin(), boxes.end(), [&](const AlignedBox3d& box) { return box.contains(centres[i]); }))
      near.push_back(i);
  return near;
}
}  // namespace

std::vector<std::uint8_t> BodyFilter::near(const VoxelGrid& grid, const std::vector<Vector3d>& centres,
                                           const PlanningScene& scene, const double* state, double padding,
                                           const std::set<std::string>& objects)
{
  std::vector<Isometry3d> link_poses(scene.robot->links().size());
  scene.robot->linkPoses(state, link_poses.data());
  std::vector<std::uint8_t> flags(centres.size(), 0);
  PlanningScene bodies = paddedBodies(scene, link_poses, padding, objects);
  const std::vector<std::size_t> near =
      cubesNear(bodies, link_poses, 0.5 * grid.size() + padding + kCubeMargin, centres);
  if (near.empty())
    return flags;
  const std::size_t first_attached = link_poses.size() + 1;  // bodies: the links, the cubes, the attached objects
  std::vector<std::uint8_t> flag_of_body(first_attached, kNearRobot);
  std::string cubes;  // a unique name: it is longer than the names of all links and attached objects
  for (const Link& link : scene.robot->links())
    cubes += link.name;
  for (std::size_t i = 0; i < bodies.attached.size(); ++i)
  {
    const std::string& id = bodies.attached[i].object.id;
    flag_of_body.push_back(objects.count(id) != 0 ? kNearObject : kNearRobot);
    cubes += id;
  }
  std::vector<Vector3d> near_centres;
  near_centres.reserve(near.size());
  for (const std::size_t cube : near)
    near_centres.push_back(centres[cube]);
  bodies.objects.push_back({cubes + "_", Isometry3d::Identity(), grid.cubesAt(near_centres), 0.0});
  CollisionProblem problem = maker_.make(bodies, "", nullptr);
  problem.self_pairs.clear();
  const auto shared = std::make_shared<const CollisionProblem>(std::move(problem));
  const auto exact = trees_.exactCheckerOf(shared);
  ExactChecker::Scratch scratch;
  for (const InstancePair& pair : exact->collidingInstances(link_poses.data(), scratch))
    flags[near[pair[1] - shared->robot.size()]] |= flag_of_body[static_cast<std::size_t>(shared->robot[pair[0]].body)];
  return flags;
}
}  // namespace gpu_planning_scene::core
