#include <algorithm>
#include <cctype>
#include <set>

#include "gpu_planning_scene/octomap.h"
#include "model/rigid_pose.h"
#include "scene/files/scene_keys.h"
#include "scene/files/scene_reader.h"
#include "scene/missing_link.h"
#include "scene/solid_rules.h"
#include "scene/validate_scene.h"

namespace gpu_planning_scene::core
{
namespace
{
const std::vector<YamlValue>& itemsOf(const YamlValue* parent, const char* key)
{
  static const std::vector<YamlValue> none;
  const YamlValue* list = parent ? parent->find(key) : nullptr;
  return list ? list->items() : none;
}

void requireAdd(const YamlValue& object)
{
  const YamlValue* operation = object.find("operation");
  if (!operation)
    return;
  std::string name = operation->text();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  if (name != "0" && name != "add")
    operation->fail("operation " + operation->text() +
                    " is not allowed: a scene file describes a full scene, so each object must be added (0)");
}

std::map<std::string, Eigen::Isometry3d> readSubframes(const YamlValue& object)
{
  std::map<std::string, Eigen::Isometry3d> subframes;
  const auto& names = itemsOf(&object, "subframe_names");
  const auto& poses = itemsOf(&object, "subframe_poses");
  if (poses.size() != names.size())
    object.fail(std::to_string(poses.size()) + " subframe_poses for " + std::to_string(names.size()) +
                " subframe_names");
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!subframes.emplace(names[i].text(), readPose(poses[i])).second)
      names[i].fail("subframe '" + names[i].text() + "' is given twice");
  return subframes;
}

ObjectType readObjectType(const YamlValue& value, const SceneReader& reader)
{
  checkKeys(value, SceneMap::ObjectType, reader.warnings);
  ObjectType type;
  if (const YamlValue* key = value.find("key"))
    type.key = key->text();
  if (const YamlValue* db = value.find("db"))
    type.db = db->text();
  return type;
}

/// Reads an object. Its pose is in the frame that its header names.
WorldObject readObject(const YamlValue& value, SceneReader& reader)
{
  checkKeys(value, SceneMap::Object, reader.warnings);
  requireAdd(value);
  WorldObject object;
  object.id = value.at("id").text();
  if (object.id.empty())
    value.fail("the object has no id");
  if (object.id == kOctomapId)
    value.fail("the id '" + object.id + "' is kept for the octomap; give it as world.octomap");
  object.shapes = readShapes(value, reader);
  if (object.shapes.empty())
  {
    const std::string unknown = unknownKey(value, SceneMap::Object);
    value.fail("object '" + object.id + "' has no shapes; give it primitives, meshes or planes" +
               (unknown.empty() ? "" : "; unknown key '" + unknown + "'"));
  }
  if (const YamlValue* solid = value.find("solid"))
  {
    if (!solidRuleOf(object.shapes))
      solid->fail("object '" + object.id + "' has no mesh; only meshes have a rule for their solid");
    setSolidRule(object.shapes, readSolidRule(*solid));
  }
  if (const YamlValue* type = value.find("type"))
    object.type = readObjectType(*type, reader);
  // An unset pose counts as no pose. An object with one shape then takes the pose of that shape, as in messages.
  const YamlValue* pose = value.find("pose");
  if (pose && !isUnsetPose(*pose))
    object.pose = readPose(*pose);
  else if (object.shapes.size() == 1)
    std::swap(object.pose, object.shapes.front().pose);
  object.padding = reader.defaults.object_padding;
  object.subframes = readSubframes(value);
  return object;
}

/// The index of the link that `value` names.
int readLink(const YamlValue& value, const SceneReader& reader)
{
  const int link = reader.robot.linkIndex(value.text());
  if (link < 0)
    value.fail("the robot " + noLinkText(reader.robot, value.text()));
  return link;
}

/// The pose in the link's frame of the frame that `header` names. Without a header or a name: the link's own frame.
Eigen::Isometry3d readFrameInLink(const YamlValue* header, int link, SceneReader& reader)
{
  const YamlValue* frame = frameOf(header);
  const std::string& link_name = reader.robot.links()[link].name;
  if (!frame || frame->text() == link_name || frame->text() == "/" + link_name)
    return Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d frame_pose = readFrame(header, reader);
  if (reader.state.empty())
    frame->fail("frame '" + frame->text() + "' is not the frame of link '" + link_name +
                "'; give the robot_state in which the object is attached");
  reader.has_link_frames = true;
  std::vector<Eigen::Isometry3d> poses(reader.robot.links().size());
  reader.robot.linkPoses(reader.state.data(), poses.data());
  return poses[link].inverse() * frame_pose;
}

AttachedObject readAttached(const YamlValue& value, SceneReader& reader)
{
  checkKeys(value, SceneMap::AttachedObject, reader.warnings);
  AttachedObject attached;
  attached.link = readLink(value.at("link_name"), reader);
  const YamlValue& object = value.at("object");
  attached.object = readObject(object, reader);
  attached.padding = reader.defaults.attached_padding;
  if (hasHalfSpace(attached.object.shapes))
    object.at("planes").fail("a plane cannot be attached; put object '" + attached.object.id + "' into the world");
  attached.object.pose = readFrameInLink(object.find("header"), attached.link, reader) * attached.object.pose;
  if (const YamlValue* links = value.find("touch_links"))
    for (const YamlValue& link : links->items())
      attached.touch_links.push_back(readLink(link, reader));
  if (const YamlValue* posture = value.find("detach_posture"))
    attached.detach_posture = readTrajectory(*posture, reader);
  if (const YamlValue* weight = value.find("weight"))
    attached.weight = weight->number();
  if (attached.weight < 0.0)
    value.at("weight").fail("the weight is negative; it must be at least 0 kg");
  return attached;
}
}  // namespace

void readObjects(const YamlValue& scene, SceneReader& reader, PlanningScene& result)
{
  std::set<std::string> ids;
  const auto require_new = [&](const std::string& id, const YamlValue& value)
  {
    if (!ids.insert(id).second)
      value.fail("object '" + id + "' is given twice");
    if (reader.robot.linkIndex(id) >= 0)
      value.fail("object '" + id + "' has the name of a link");
  };
  const YamlValue* world = scene.find("world");
  if (world)
    checkKeys(*world, SceneMap::World, reader.warnings);
  for (const YamlValue& value : itemsOf(world, "collision_objects"))
  {
    WorldObject object = readObject(value, reader);
    object.pose = readFrame(value.find("header"), reader) * object.pose;
    if (!isRigid(object.pose))
      value.fail("object '" + object.id + "' is farther than 1000 km away");
    require_new(object.id, value);
    result.objects.push_back(std::move(object));
  }
  for (const YamlValue& value : itemsOf(scene.find("robot_state"), "attached_collision_objects"))
  {
    AttachedObject attached = readAttached(value, reader);
    require_new(attached.object.id, value);
    result.scaleAttached(attached);
    result.attached.push_back(std::move(attached));
  }
}
}  // namespace gpu_planning_scene::core
