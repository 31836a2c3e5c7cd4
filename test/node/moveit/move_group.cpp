#include "node/moveit/move_group.h"

#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "gpu_planning_scene/moveit/collision_detector_allocator.h"

namespace gpu_planning_scene::core
{
namespace
{
using planning_scene::PlanningScene;

constexpr double kSame = 1e-9;

bool same(const geometry_msgs::Point& a, const geometry_msgs::Point& b)
{
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) < kSame;
}

bool same(const geometry_msgs::Quaternion& a, const geometry_msgs::Quaternion& b)
{
  return std::abs(std::abs(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w) - 1.0) < kSame;
}

bool same(const geometry_msgs::Pose& a, const geometry_msgs::Pose& b)
{
  return same(a.position, b.position) && same(a.orientation, b.orientation);
}

template <class T>
bool samePoses(const std::vector<T>& a, const std::vector<T>& b)
{
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return same(x, y); });
}

template <class T>
std::string bytesOf(const T& message)
{
  std::string bytes(ros::serialization::serializationLength(message), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                     static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

std::string differenceOfObjects(const moveit_msgs::CollisionObject& a, const moveit_msgs::CollisionObject& b)
{
  if (a.header.frame_id != b.header.frame_id)
    return "frame " + a.header.frame_id + " " + b.header.frame_id;
  if (!same(a.pose, b.pose))
    return "pose";
  if (bytesOf(a.primitives) != bytesOf(b.primitives) || bytesOf(a.planes) != bytesOf(b.planes))
    return "primitives or planes";
  if (bytesOf(a.meshes) != bytesOf(b.meshes))
    return "meshes";
  if (!samePoses(a.primitive_poses, b.primitive_poses) || !samePoses(a.mesh_poses, b.mesh_poses) ||
      !samePoses(a.plane_poses, b.plane_poses))
    return "poses of shapes";
  if (a.subframe_names != b.subframe_names || !samePoses(a.subframe_poses, b.subframe_poses))
    return "subframes";
  if (a.type.key != b.type.key || a.type.db != b.type.db)
    return "type";
  return "";
}

std::string differenceOfAttached(const moveit_msgs::AttachedCollisionObject& a,
                                 const moveit_msgs::AttachedCollisionObject& b)
{
  if (a.link_name != b.link_name)
    return "link";
  if (std::set<std::string>(a.touch_links.begin(), a.touch_links.end()) !=
      std::set<std::string>(b.touch_links.begin(), b.touch_links.end()))
    return "touch links";
  if (bytesOf(a.detach_posture.points) != bytesOf(b.detach_posture.points))
    return "detach_posture";
  return differenceOfObjects(a.object, b.object);
}

template <class Item, class Name>
std::map<std::string, Item> byName(const std::vector<Item>& items, Name name)
{
  std::map<std::string, Item> map;
  for (const Item& item : items)
    map[name(item)] = item;
  return map;
}

template <class Item, class Name, class Difference>
std::string differenceOfLists(const char* what, const std::vector<Item>& a, const std::vector<Item>& b, Name name,
                              Difference difference)
{
  const auto first = byName(a, name);
  const auto second = byName(b, name);
  for (const auto& [id, item] : first)
    if (second.count(id) == 0)
      return std::string(what) + " '" + id + "' is missing";
    else if (const std::string text = difference(item, second.at(id)); !text.empty())
      return std::string(what) + " '" + id + "': " + text;
  for (const auto& [id, item] : second)
    if (first.count(id) == 0)
      return std::string(what) + " '" + id + "' is too much";
  return "";
}

/// The pairs that the matrix allows.
std::set<std::pair<std::string, std::string>> allowedPairs(const moveit_msgs::AllowedCollisionMatrix& matrix)
{
  std::set<std::pair<std::string, std::string>> pairs;
  for (std::size_t i = 0; i < matrix.entry_names.size(); ++i)
    for (std::size_t j = 0; j < matrix.entry_names.size(); ++j)
      if (i != j && matrix.entry_values[i].enabled[j])
        pairs.emplace(matrix.entry_names[i], matrix.entry_names[j]);
  return pairs;
}

/// The fixed frames without the planning frame, which MoveIt lists too.
std::vector<geometry_msgs::TransformStamped> otherFrames(const moveit_msgs::PlanningScene& scene)
{
  std::vector<geometry_msgs::TransformStamped> frames;
  for (const geometry_msgs::TransformStamped& frame : scene.fixed_frame_transforms)
    if (frame.header.frame_id != frame.child_frame_id)
      frames.push_back(frame);
  return frames;
}

std::string textOf(double a, double b)
{
  std::ostringstream text;
  text << a << " and " << b;
  return text.str();
}

moveit_msgs::CollisionObject operation(const std::string& id, std::int8_t operation)
{
  moveit_msgs::CollisionObject object;
  object.id = id;
  object.operation = operation;
  return object;
}

shape_msgs::Mesh tetrahedron(double size)
{
  shape_msgs::Mesh mesh;
  mesh.vertices.resize(4);
  mesh.vertices[1].x = mesh.vertices[2].y = mesh.vertices[3].z = size;
  mesh.triangles.resize(4);
  mesh.triangles[0].vertex_indices = {{0, 2, 1}};
  mesh.triangles[1].vertex_indices = {{0, 1, 3}};
  mesh.triangles[2].vertex_indices = {{0, 3, 2}};
  mesh.triangles[3].vertex_indices = {{1, 2, 3}};
  return mesh;
}
}  // namespace

std::string differenceOf(const moveit_msgs::PlanningScene& a, const moveit_msgs::PlanningScene& b)
{
  if (a.name != b.name)
    return "name " + a.name + " " + b.name;
  std::string text = differenceOfLists(
      "object", a.world.collision_objects, b.world.collision_objects, [](const auto& object) { return object.id; },
      differenceOfObjects);
  if (text.empty())
    text = differenceOfLists(
        "attached object", a.robot_state.attached_collision_objects, b.robot_state.attached_collision_objects,
        [](const auto& attached) { return attached.object.id; }, differenceOfAttached);
  if (text.empty() && allowedPairs(a.allowed_collision_matrix) != allowedPairs(b.allowed_collision_matrix))
    text = "allowed collision matrix";
  if (text.empty())
    text = differenceOfLists(
        "colour of", a.object_colors, b.object_colors, [](const auto& color) { return color.id; },
        [](const auto& x, const auto& y) { return bytesOf(x) == bytesOf(y) ? "" : "colour"; });
  if (text.empty())
    text = differenceOfLists(
        "padding of", a.link_padding, b.link_padding, [](const auto& item) { return item.link_name; },
        [](const auto& x, const auto& y) { return x.padding == y.padding ? "" : textOf(x.padding, y.padding); });
  if (text.empty())
    text = differenceOfLists(
        "scale of", a.link_scale, b.link_scale, [](const auto& item) { return item.link_name; },
        [](const auto& x, const auto& y) { return x.scale == y.scale ? "" : textOf(x.scale, y.scale); });
  if (text.empty())
    text = differenceOfLists(
        "fixed frame", otherFrames(a), otherFrames(b), [](const auto& frame) { return frame.header.frame_id; },
        [](const auto& x, const auto& y)
        {
          geometry_msgs::Point p, q;
          p.x = x.transform.translation.x, p.y = x.transform.translation.y, p.z = x.transform.translation.z;
          q.x = y.transform.translation.x, q.y = y.transform.translation.y, q.z = y.transform.translation.z;
          return same(p, q) && same(x.transform.rotation, y.transform.rotation) ? "" : "transform";
        });
  return text;
}

MoveGroup::MoveGroup(const moveit::core::RobotModelConstPtr& model, std::string name)
  : name_(std::move(name)), parent_(std::make_shared<PlanningScene>(model))
{
  parent_->setActiveCollisionDetector(detector::CollisionDetectorAllocator::create(), true);
  parent_->getCurrentStateNonConst().setToDefaultValues();
  scene_ = parent_->diff();
  start();
}

void MoveGroup::start()
{
  publisher_ = node_.advertise<moveit_msgs::PlanningScene>(name_ + "/monitored_planning_scene", 100);
  service_ = node_.advertiseService(ros::names::append(ros::names::parentNamespace(name_), "get_planning_scene"),
                                    &MoveGroup::answer, this);
}

void MoveGroup::stop()
{
  publisher_.shutdown();
  service_.shutdown();
}

void MoveGroup::hang(bool hangs)
{
  if (hangs)
    hanging_.lock();
  else
    hanging_.unlock();
}

bool MoveGroup::answer(moveit_msgs::GetPlanningScene::Request& request,
                       moveit_msgs::GetPlanningScene::Response& response)
{
  const std::lock_guard<std::mutex> hanging(hanging_);
  const std::lock_guard<std::mutex> lock(mutex_);
  scene_->getPlanningSceneMsg(response.scene, request.components);
  if (alter_)
    alter_(response.scene);
  return true;
}

void MoveGroup::alterAnswers(const std::function<void(moveit_msgs::PlanningScene&)>& alter)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  alter_ = alter;
}

void MoveGroup::change(const std::function<void(PlanningScene&)>& make)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  make(*scene_);
}

void MoveGroup::publish(bool is_lost)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  moveit_msgs::PlanningScene message;
  scene_->getPlanningSceneDiffMsg(message);
  scene_->pushDiffs(parent_);
  scene_->clearDiffs();
  if (!is_lost)
    publisher_.publish(message);
}

moveit_msgs::PlanningScene MoveGroup::whole()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  moveit_msgs::PlanningScene message;
  scene_->getPlanningSceneMsg(message);
  return message;
}

std::vector<bool> MoveGroup::verdicts(const std::vector<moveit::core::RobotState>& states)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<moveit::core::AttachedBody*> none;
  std::vector<bool> valid;
  for (const moveit::core::RobotState& state : states)
  {
    moveit::core::RobotState with_objects = scene_->getCurrentState();
    with_objects.setVariablePositions(state.getVariablePositions());
    with_objects.update();
    valid.push_back(!scene_->isStateColliding(with_objects));
  }
  return valid;
}

geometry_msgs::Pose RandomChanges::pose(double reach)
{
  geometry_msgs::Pose pose;
  pose.position.x = number(-reach, reach);
  pose.position.y = number(-reach, reach);
  pose.position.z = number(0.0, reach);
  Eigen::Quaterniond rotation(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0));
  rotation.normalize();
  pose.orientation.x = rotation.x();
  pose.orientation.y = rotation.y();
  pose.orientation.z = rotation.z();
  pose.orientation.w = rotation.w();
  return pose;
}

moveit_msgs::CollisionObject RandomChanges::object(const std::string& id, const std::string& frame, double reach)
{
  moveit_msgs::CollisionObject object = operation(id, moveit_msgs::CollisionObject::ADD);
  object.header.frame_id = frame;
  object.pose = pose(reach);
  const double size = number(0.02, 0.2);
  if (index(4) == 0)
  {
    object.meshes.push_back(tetrahedron(size));
    object.mesh_poses.push_back(pose(0.1));
  }
  for (int count = (object.meshes.empty() ? 1 : 0) + index(2); count > 0; --count)
  {
    shape_msgs::SolidPrimitive primitive;
    primitive.type = static_cast<std::uint8_t>(1 + index(4));
    primitive.dimensions.assign(primitive.type == shape_msgs::SolidPrimitive::BOX      ? 3
                                : primitive.type == shape_msgs::SolidPrimitive::SPHERE ? 1
                                                                                       : 2,
                                size);
    object.primitives.push_back(primitive);
    object.primitive_poses.push_back(pose(0.1));
  }
  if (index(3) == 0)
  {
    object.subframe_names.emplace_back("tip");
    object.subframe_poses.push_back(pose(0.1));
  }
  if (index(3) == 0)
  {
    object.type.key = "key of " + id;
    object.type.db = "db";
  }
  return object;
}

std::string RandomChanges::worldObject(const PlanningScene& scene)
{
  const std::vector<std::string> ids = scene.getWorld()->getObjectIds();
  return ids.empty() ? "" : ids[static_cast<std::size_t>(index(ids.size()))];
}

void RandomChanges::operator()(PlanningScene& scene)
{
  const std::string known = worldObject(scene);
  std::vector<const moveit::core::AttachedBody*> attached;
  scene.getCurrentState().getAttachedBodies(attached);
  moveit_msgs::AttachedCollisionObject carried;
  carried.link_name = link();
  carried.touch_links = {carried.link_name, "panda_link6", "panda_link7"};
  switch (index(12))
  {
    case 0:
    case 1:
    case 2:
    {
      const std::string id = "object" + std::to_string(index(30));
      if (!scene.getCurrentState().hasAttachedBody(id))
        scene.processCollisionObjectMsg(object(id, scene.getPlanningFrame(), 0.8));
      return;
    }
    case 3:
    case 4:
      if (!known.empty())
      {
        moveit_msgs::CollisionObject move = operation(known, moveit_msgs::CollisionObject::MOVE);
        move.header.frame_id = scene.getPlanningFrame();
        move.pose = pose(0.8);
        scene.processCollisionObjectMsg(move);
      }
      return;
    case 5:
    case 6:
      if (!known.empty())
        scene.processCollisionObjectMsg(operation(known, moveit_msgs::CollisionObject::REMOVE));
      return;
    case 7:
      if (attached.size() < 3 && !known.empty())
        carried.object = operation(known, moveit_msgs::CollisionObject::ADD);
      else if (attached.size() < 3)
        carried.object = object("carried" + std::to_string(index(3)), carried.link_name, 0.15);
      else
        return;
      scene.processAttachedCollisionObjectMsg(carried);
      return;
    case 8:
      if (attached.empty())
        return;
      carried.link_name = attached.front()->getAttachedLinkName();
      carried.object = operation(attached.front()->getName(), moveit_msgs::CollisionObject::REMOVE);
      scene.processAttachedCollisionObjectMsg(carried);
      return;
    case 9:
      if (!known.empty())
        scene.getAllowedCollisionMatrixNonConst().setEntry(known, link(), index(2) == 0);
      return;
    case 10:
      if (!known.empty())
      {
        std_msgs::ColorRGBA color;
        color.r = static_cast<float>(number(0.0, 1.0));
        color.a = 1.0F;
        scene.setObjectColor(known, color);
      }
      return;
    default:
    {
      moveit_msgs::PlanningScene diff;
      diff.is_diff = true;
      diff.robot_state.is_diff = true;
      diff.link_padding.resize(1);
      diff.link_padding[0].link_name = link();
      diff.link_padding[0].padding = 0.01 * index(5);
      diff.robot_state.joint_state.name = {"panda_joint1", "panda_joint4"};
      diff.robot_state.joint_state.position = {number(-2.0, 2.0), number(-2.5, -0.5)};
      scene.setPlanningSceneDiffMsg(diff);
    }
  }
}
}  // namespace gpu_planning_scene::core
