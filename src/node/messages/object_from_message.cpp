#include "node/messages/object_from_message.h"

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "model/coordinate_hash.h"
#include "scene/message_values.h"

namespace gpu_planning_scene::core
{
namespace
{
std::size_t hashOfMesh(const Mesh& mesh)
{
  std::size_t hash = mesh.triangles.size();
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    hash = hashOf(vertex, hash);
  return hash;
}

Operation operationOf(const CollisionObject& message)
{
  switch (message.operation)
  {
    case CollisionObject::ADD:
      return Operation::Add;
    case CollisionObject::REMOVE:
      return Operation::Remove;
    case CollisionObject::APPEND:
      return Operation::Append;
    case CollisionObject::MOVE:
      return Operation::Move;
    default:
      throw Error("object '" + message.id + "': unknown operation " +
                  std::to_string(static_cast<int>(message.operation)) + "; known are ADD (0), REMOVE (1), APPEND (2) " +
                  "and MOVE (3)");
  }
}

class ShapeReader
{
 public:
  ShapeReader(const CollisionObject& message, InlineMeshes& meshes) : message_(message), meshes_(meshes) {}

  std::vector<PlacedShape> read()
  {
    add(
        message_.primitives, message_.primitive_poses, "primitive",
        [](const shape_msgs::SolidPrimitive& primitive)
        { return primitiveOf(static_cast<PrimitiveType>(primitive.type), primitive.dimensions); });
    add(
        message_.meshes, message_.mesh_poses, "mesh",
        [this](const shape_msgs::Mesh& mesh) { return meshes_.meshOf(mesh, message_.id); });
    add(message_.planes, message_.plane_poses, "plane",
        [](const shape_msgs::Plane& plane) { return halfSpaceBehind(Eigen::Vector4d(plane.coef.data())); });
    return std::move(shapes_);
  }

 private:
  /// A shape without a pose gets the identity, as in MoveIt.
  template <class Messages, class Read>
  void add(const Messages& messages, const std::vector<geometry_msgs::Pose>& poses, const char* kind, const Read& read)
  {
    const std::string where = "object '" + message_.id + "'";
    if (poses.size() > messages.size())
      throw Error(where + ": " + std::to_string(poses.size()) + " " + kind + "_poses for " +
                  std::to_string(messages.size()));
    for (std::size_t i = 0; i < messages.size(); ++i)
      try
      {
        shapes_.push_back({read(messages[i])});
        if (i < poses.size())
          shapes_.back().pose = isometryOf(poses[i]);
      }
      catch (const Error& error)
      {
        throw Error(where + ", " + kind + " " + std::to_string(i) + ": " + error.what());
      }
  }

  const CollisionObject& message_;
  InlineMeshes& meshes_;
  std::vector<PlacedShape> shapes_;
};
}  // namespace

std::shared_ptr<const Mesh> InlineMeshes::meshOf(const shape_msgs::Mesh& message, const std::string& object)
{
  Mesh mesh;
  mesh.name = object;
  mesh.vertices.reserve(message.vertices.size());
  for (const geometry_msgs::Point& vertex : message.vertices)
    mesh.vertices.emplace_back(vertex.x, vertex.y, vertex.z);
  mesh.triangles.reserve(message.triangles.size());
  for (const shape_msgs::MeshTriangle& triangle : message.triangles)
    mesh.triangles.push_back({triangle.vertex_indices[0], triangle.vertex_indices[1], triangle.vertex_indices[2]});
  const std::size_t hash = hashOfMesh(mesh);
  const auto [first, last] = meshes_.equal_range(hash);
  for (auto known = first; known != last; ++known)
    if (known->second->triangles == mesh.triangles && known->second->vertices == mesh.vertices)
      return known->second;
  return meshes_.emplace(hash, std::make_shared<const Mesh>(std::move(mesh)))->second;
}

JointTrajectory postureFrom(const trajectory_msgs::JointTrajectory& message)
{
  JointTrajectory posture;
  posture.frame_id = message.header.frame_id;
  posture.stamp = static_cast<std::int64_t>(message.header.stamp.toNSec());
  posture.joint_names = message.joint_names;
  for (const trajectory_msgs::JointTrajectoryPoint& point : message.points)
    posture.points.push_back(
        {point.positions, point.velocities, point.accelerations, point.effort, point.time_from_start.toNSec()});
  return posture;
}

bool isUnset(const geometry_msgs::Pose& pose)
{
  const geometry_msgs::Point& p = pose.position;
  const geometry_msgs::Quaternion& q = pose.orientation;
  return p.x == 0.0 && p.y == 0.0 && p.z == 0.0 && q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0;
}

Eigen::Quaterniond rotationOf(const geometry_msgs::Quaternion& message)
{
  const Eigen::Vector4d components(message.x, message.y, message.z, message.w);
  const double norm = components.stableNorm();
  if (norm == 0.0)
    return Eigen::Quaterniond::Identity();
  // Division by the stable norm comes first, so that squares of large components do not overflow in normalized().
  return Eigen::Quaterniond(Eigen::Vector4d(components / norm)).normalized();
}

ObjectChange objectChangeFrom(const CollisionObject& message, InlineMeshes& meshes)
{
  ObjectChange change;
  change.operation = operationOf(message);
  change.id = message.id;
  if (change.id == kOctomapId)
    throw Error("object '" + change.id + "': this id is kept for the octomap; send it as world.octomap");
  if (change.operation == Operation::Remove)
    return change;
  change.frame = {message.header.frame_id, static_cast<std::int64_t>(message.header.stamp.toNSec())};
  if (!isUnset(message.pose))
    change.pose = isometryOf(message.pose);
  change.type = {message.type.key, message.type.db};
  if (message.subframe_poses.size() != message.subframe_names.size())
    throw Error("object '" + message.id + "': " + std::to_string(message.subframe_poses.size()) +
                " subframe_poses for " + std::to_string(message.subframe_names.size()) + " subframe_names");
  for (std::size_t i = 0; i < message.subframe_names.size(); ++i)
    if (!change.subframes.emplace(message.subframe_names[i], isometryOf(message.subframe_poses[i])).second)
      throw Error("object '" + message.id + "': subframe '" + message.subframe_names[i] + "' is given twice");
  const bool has_shapes = !message.primitives.empty() || !message.meshes.empty() || !message.planes.empty();
  if (change.operation != Operation::Move || has_shapes)
    change.shapes = ShapeReader(message, meshes).read();
  else
    for (const auto* poses : {&message.primitive_poses, &message.mesh_poses, &message.plane_poses})
      for (const geometry_msgs::Pose& pose : *poses)
        change.shape_poses.push_back(isometryOf(pose));
  return change;
}

AttachedChange attachedChangeFrom(const AttachedCollisionObject& message, InlineMeshes& meshes)
{
  AttachedChange change;
  change.object = objectChangeFrom(message.object, meshes);
  change.link = message.link_name;
  change.touch_links = message.touch_links;
  change.detach_posture = postureFrom(message.detach_posture);
  change.weight = message.weight;
  return change;
}
}  // namespace gpu_planning_scene::core
