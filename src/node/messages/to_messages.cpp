#include "node/messages/to_messages.h"

#include <algorithm>

#include "gpu_planning_scene/octomap.h"
#include "node/messages/exact_numbers.h"
#include "node/messages/octomap_messages.h"
#include "node/messages/pose_messages.h"
#include "scene/message_values.h"

namespace gpu_planning_scene::core
{
namespace
{
geometry_msgs::Transform transformOf(const Eigen::Isometry3d& pose)
{
  geometry_msgs::Transform message;
  setPosition(message.translation, pose.translation());
  message.rotation = orientationOf(pose);
  return message;
}

std::uint8_t messageOf(SolidRule rule)
{
  return rule == SolidRule::Auto      ? BodySolid::AUTO
         : rule == SolidRule::Surface ? BodySolid::SURFACE
                                      : BodySolid::FILLED;
}

/// Adds a shape and its pose to the lists of its kind in the message.
struct AddShape
{
  CollisionObject& message;
  const Eigen::Isometry3d& pose;

  void operator()(const Box& box) const
  {
    addPrimitive(shape_msgs::SolidPrimitive::BOX, {box.size.x(), box.size.y(), box.size.z()});
  }
  void operator()(const Sphere& sphere) const { addPrimitive(shape_msgs::SolidPrimitive::SPHERE, {sphere.radius}); }
  void operator()(const Cylinder& cylinder) const
  {
    addPrimitive(shape_msgs::SolidPrimitive::CYLINDER, {cylinder.length, cylinder.radius});
  }
  void operator()(const Cone& cone) const
  {
    addPrimitive(shape_msgs::SolidPrimitive::CONE, {cone.length, cone.radius});
  }
  void operator()(const HalfSpace& half_space) const
  {
    shape_msgs::Plane plane;
    plane.coef = {half_space.normal.x(), half_space.normal.y(), half_space.normal.z(), -half_space.offset};
    message.planes.push_back(plane);
    message.plane_poses.push_back(poseOf(pose));
  }
  void operator()(const std::shared_ptr<const Mesh>& mesh) const
  {
    message.meshes.emplace_back();
    shape_msgs::Mesh& result = message.meshes.back();
    result.vertices.resize(mesh->vertices.size());
    for (std::size_t i = 0; i < mesh->vertices.size(); ++i)
      setPosition(result.vertices[i], mesh->vertices[i]);
    result.triangles.resize(mesh->triangles.size());
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i)
      std::copy(mesh->triangles[i].begin(), mesh->triangles[i].end(), result.triangles[i].vertex_indices.begin());
    message.mesh_poses.push_back(poseOf(pose));
  }

 private:
  void addPrimitive(std::uint8_t type, std::vector<double> dimensions) const
  {
    shape_msgs::SolidPrimitive primitive;
    primitive.type = type;
    primitive.dimensions = std::move(dimensions);
    message.primitives.push_back(std::move(primitive));
    message.primitive_poses.push_back(poseOf(pose));
  }
};

std::int8_t operationOf(Operation operation)
{
  switch (operation)
  {
    case Operation::Remove:
      return CollisionObject::REMOVE;
    case Operation::Append:
      return CollisionObject::APPEND;
    case Operation::Move:
      return CollisionObject::MOVE;
    case Operation::Add:
      break;
  }
  return CollisionObject::ADD;
}

/// The shape poses of a Move all go to primitive_poses: a reader of the message joins its three lists of poses.
CollisionObject messageOf(const ObjectChange& change, const std::string& planning_frame)
{
  CollisionObject message;
  message.operation = operationOf(change.operation);
  message.id = change.id;
  message.type.key = change.type.key;
  message.type.db = change.type.db;
  message.header.frame_id = change.frame.name.empty() ? planning_frame : change.frame.name;
  message.header.stamp.fromNSec(static_cast<std::uint64_t>(change.frame.stamp));
  if (change.pose)
    message.pose = poseOf(*change.pose);
  for (const PlacedShape& placed : change.shapes)
    std::visit(AddShape{message, placed.pose}, placed.shape);
  for (const Eigen::Isometry3d& pose : change.shape_poses)
    message.primitive_poses.push_back(poseOf(pose));
  for (const auto& [name, pose] : change.subframes)
  {
    message.subframe_names.push_back(name);
    message.subframe_poses.push_back(poseOf(pose));
  }
  return message;
}

trajectory_msgs::JointTrajectory messageOf(const JointTrajectory& posture)
{
  trajectory_msgs::JointTrajectory message;
  message.header.frame_id = posture.frame_id;
  message.header.stamp.fromNSec(static_cast<std::uint64_t>(posture.stamp));
  message.joint_names = posture.joint_names;
  for (const JointTrajectory::Point& point : posture.points)
  {
    message.points.emplace_back();
    trajectory_msgs::JointTrajectoryPoint& added = message.points.back();
    added.positions = point.positions;
    added.velocities = point.velocities;
    added.accelerations = point.accelerations;
    added.effort = point.effort;
    added.time_from_start.fromNSec(point.time_from_start);
  }
  return message;
}

AttachedCollisionObject messageOf(const AttachedChange& change, const std::string& planning_frame)
{
  AttachedCollisionObject message;
  message.link_name = change.link;
  message.object = messageOf(change.object, planning_frame);
  message.touch_links = change.touch_links;
  message.detach_posture = messageOf(change.detach_posture);
  message.weight = change.weight;
  return message;
}

/// Writes the variables. A planar or floating joint becomes a transform if all of its variables are given.
void setVariables(const std::map<std::string, double>& variables, const RobotModel& robot, RobotState& message)
{
  message.joint_state.header.frame_id = robot.planningFrame();
  message.multi_dof_joint_state.header.frame_id = robot.planningFrame();
  for (const Joint& joint : robot.joints())
  {
    if (joint.mimic || joint.type == JointType::Fixed)
      continue;
    std::vector<std::string> names;
    std::vector<double> values;
    const int count = variableCount(joint.type);
    for (int i = joint.first_variable; i < joint.first_variable + count; ++i)
      if (const auto found = variables.find(robot.variables()[static_cast<std::size_t>(i)].name);
          found != variables.end())
      {
        names.push_back(found->first);
        values.push_back(found->second);
      }
    if (count > 1 && names.size() == static_cast<std::size_t>(count))
    {
      message.multi_dof_joint_state.joint_names.push_back(joint.name);
      message.multi_dof_joint_state.transforms.push_back(transformOf(poseOfVariables(joint, values.data())));
      continue;
    }
    message.joint_state.name.insert(message.joint_state.name.end(), names.begin(), names.end());
    message.joint_state.position.insert(message.joint_state.position.end(), values.begin(), values.end());
  }
}

/// Writes an entry for each pair of names that have entries. Pairs without an entry get the value of the defaults.
AllowedCollisionMatrixMessage messageOf(const AllowedCollisionMatrix& matrix, const std::string& a_link)
{
  AllowedCollisionMatrixMessage message;
  message.entry_names = matrix.bodiesWithEntries();
  // A message without names leaves the matrix as it is. A message with a single name sets an empty matrix.
  if (message.entry_names.empty())
    message.entry_names.push_back(a_link);
  message.entry_values.resize(message.entry_names.size());
  for (std::size_t i = 0; i < message.entry_names.size(); ++i)
  {
    const AllowedCollisionMatrix::Row row = matrix.row(message.entry_names[i]);
    for (const std::string& other : message.entry_names)
      message.entry_values[i].enabled.push_back(row.allowed(matrix.row(other)) ? 1 : 0);
  }
  for (const std::string& name : matrix.bodies())
    if (const std::optional<bool> default_allowed = matrix.defaultOf(name))
    {
      message.default_entry_names.push_back(name);
      message.default_entry_values.push_back(*default_allowed ? 1 : 0);
    }
  return message;
}

/// The change that makes the requested components of the scene, without the values of variables.
SceneChange changeOf(const PlanningScene& scene, std::uint32_t components)
{
  using Components = PlanningSceneComponents;
  const RobotModel& robot = *scene.robot;
  const auto wanted = [&](std::uint32_t component) { return (components & component) != 0; };
  SceneChange change;
  change.state.is_diff = false;
  if (wanted(Components::SCENE_SETTINGS))
  {
    change.name = scene.name;
    change.robot_model_name = robot.name();
  }
  constexpr std::uint32_t kWithoutBodies = Components::SCENE_SETTINGS | Components::ROBOT_STATE | kForFollowers;
  if ((components & ~kWithoutBodies) == 0)
    return change;  // without a copy of the objects: clients ask often for the revision and the robot's state
  const SceneChange full = fullSceneOf(scene);
  if (wanted(Components::ROBOT_STATE_ATTACHED_OBJECTS))
    change.state.attached = full.state.attached;
  if (wanted(Components::TRANSFORMS))
    change.fixed_frames = full.fixed_frames;
  if (wanted(Components::ALLOWED_COLLISION_MATRIX))
    change.matrix = scene.allowed_collisions;
  if (wanted(Components::OBJECT_COLORS))
    change.colors = full.colors;
  if (wanted(Components::LINK_PADDING_AND_SCALING))
    for (const Link& link : robot.links())
    {
      const double padding = full.link_padding.at(link.name);
      const double scale = full.link_scale.at(link.name);
      // As in MoveIt, links without shapes are left out. Followers get them all: such a link may carry objects, and the
      // follower may have other defaults.
      if (link.shapes.empty() && padding == 0.0 && scale == 1.0 && (components & kForFollowers) == 0)
        continue;
      change.link_padding[link.name] = padding;
      change.link_scale[link.name] = scale;
    }
  for (const auto& [id, rule] : full.solids)
    if (wanted(robot.linkIndex(id) >= 0 || !scene.findAttached(id) ? Components::WORLD_OBJECT_GEOMETRY
                                                                   : Components::ROBOT_STATE_ATTACHED_OBJECTS))
      change.solids[id] = rule;
  for (const ObjectChange& object : full.objects)
    if (wanted(object.id == kOctomapId ? Components::OCTOMAP : Components::WORLD_OBJECT_GEOMETRY))
      change.objects.push_back(object);
    else if (object.id != kOctomapId && wanted(Components::WORLD_OBJECT_NAMES))
    {
      change.objects.emplace_back();
      change.objects.back().id = object.id;
    }
  return change;
}
}  // namespace

PlanningSceneMessage messageOf(const SceneChange& change, const RobotModel& robot)
{
  const std::string& planning_frame = robot.planningFrame();
  PlanningSceneMessage message;
  message.is_diff = change.is_diff;
  message.name = change.name;
  message.robot_model_name = change.robot_model_name;
  for (const auto& [name, pose] : change.fixed_frames)
  {
    geometry_msgs::TransformStamped frame;
    frame.header.frame_id = name;  // as in MoveIt: see fixedFrameName
    frame.child_frame_id = planning_frame;
    frame.transform = transformOf(pose);
    message.fixed_frame_transforms.push_back(frame);
  }
  setVariables(change.state.variables, robot, message.robot_state);
  for (const AttachedChange& attached : change.state.attached)
    message.robot_state.attached_collision_objects.push_back(messageOf(attached, planning_frame));
  message.robot_state.is_diff = change.state.is_diff;
  if (change.matrix)
    message.allowed_collision_matrix = messageOf(*change.matrix, robot.links().front().name);
  for (const auto& [link, padding] : change.link_padding)
  {
    message.link_padding.emplace_back();
    message.link_padding.back().link_name = link;
    message.link_padding.back().padding = padding;
  }
  for (const auto& [link, scale] : change.link_scale)
  {
    message.link_scale.emplace_back();
    message.link_scale.back().link_name = link;
    message.link_scale.back().scale = scale;
  }
  for (const auto& [id, color] : change.colors)
  {
    message.object_colors.emplace_back();
    message.object_colors.back().id = id;
    message.object_colors.back().color.r = color.r;
    message.object_colors.back().color.g = color.g;
    message.object_colors.back().color.b = color.b;
    message.object_colors.back().color.a = color.a;
  }
  for (const auto& [id, rule] : change.solids)
  {
    message.solids.emplace_back();
    message.solids.back().id = id;
    message.solids.back().solid = messageOf(rule);
  }
  for (const ObjectChange& object : change.objects)
    if (object.id == kOctomapId)
      message.world.octomap = octomapMessageOf(object, planning_frame);
    else
      message.world.collision_objects.push_back(messageOf(object, planning_frame));
  return message;
}

SceneChange componentsOf(const PlanningScene& scene, std::uint32_t components, const std::vector<double>& state,
                         const std::vector<bool>& known)
{
  const std::uint32_t wanted = components == 0 ? kForFollowers - 1 : components;
  SceneChange change = changeOf(scene, wanted);
  if ((wanted & PlanningSceneComponents::ROBOT_STATE) != 0)
    for (std::size_t i = 0; i < state.size(); ++i)
      if (known[i])
        change.state.variables[scene.robot->variables()[i].name] = state[i];
  return change;
}

PlanningSceneMessage messageOf(const PlanningScene& scene, std::uint32_t components, const std::vector<double>& state,
                               const std::vector<bool>& known)
{
  PlanningSceneMessage message = messageOf(componentsOf(scene, components, state, known), *scene.robot);
  message.scene_revision = scene.revision;
  return message;
}
}  // namespace gpu_planning_scene::core
