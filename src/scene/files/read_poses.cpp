#include "scene/files/scene_keys.h"
#include "scene/files/scene_reader.h"
#include "scene/frame.h"

namespace gpu_planning_scene::core
{
namespace
{
Eigen::Quaterniond readOrientation(const YamlValue& value)
{
  const bool is_map = value.kind() == YamlValue::Kind::Map;
  if (is_map)
    checkKeys(value, SceneMap::Quaternion, nullptr);
  const Eigen::Vector4d components = is_map ? Eigen::Vector4d(value.at("x").number(), value.at("y").number(),
                                                              value.at("z").number(), value.at("w").number())
                                            : Eigen::Vector4d(value.numbers(4).data());
  const double norm = components.stableNorm();
  if (norm == 0.0)
    value.fail("the quaternion is zero; the identity is [0, 0, 0, 1]");
  // The components are divided first, so that squares of large components do not overflow.
  return Eigen::Quaterniond(Eigen::Vector4d(components / norm)).normalized();
}

/// A translation and a rotation under these keys, both optional.
Eigen::Isometry3d readIsometry(const YamlValue& value, SceneMap kind, const char* position_key,
                               const char* orientation_key)
{
  checkKeys(value, kind, nullptr);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (const YamlValue* position = value.find(position_key))
    pose.translation() = readVector(*position);
  if (const YamlValue* orientation = value.find(orientation_key))
    pose.linear() = readOrientation(*orientation).toRotationMatrix();
  return pose;
}
}  // namespace

Eigen::Vector3d readVector(const YamlValue& value)
{
  if (value.kind() == YamlValue::Kind::Map)
  {
    checkKeys(value, SceneMap::Vector, nullptr);
    return Eigen::Vector3d(value.at("x").number(), value.at("y").number(), value.at("z").number());
  }
  return Eigen::Vector3d(value.numbers(3).data());
}

Eigen::Isometry3d readPose(const YamlValue& value)
{
  return readIsometry(value, SceneMap::Pose, "position", "orientation");
}

Eigen::Isometry3d readTransform(const YamlValue& value)
{
  return readIsometry(value, SceneMap::Transform, "translation", "rotation");
}

bool isUnsetPose(const YamlValue& value)
{
  for (const char* key : {"position", "orientation"})
  {
    const YamlValue* part = value.find(key);
    if (!part || part->kind() != YamlValue::Kind::Map)
      return false;
    for (const auto& member : part->members())
      if (member.second.number() != 0.0)
        return false;
  }
  return true;
}

void readFixedFrame(const YamlValue& value, SceneReader& reader)
{
  checkKeys(value, SceneMap::FixedFrame, reader.warnings);
  const std::string& planning_frame = reader.robot.planningFrame();
  const YamlValue* parent = frameOf(value.find("header"));
  const YamlValue& child = value.at("child_frame_id");
  const std::string frame_id = parent ? parent->text() : "";
  const std::optional<std::string> name = fixedFrameName(frame_id, child.text(), planning_frame);
  if (!name)
    (parent ? *parent : child)
        .fail("the transform is between frames '" + frame_id + "' and '" + child.text() +
              "'; one of them must be the planning frame '" + planning_frame +
              "' (the robot's root link, or the parent frame of the SRDF's virtual joint)");
  const Eigen::Isometry3d pose = readTransform(value.at("transform"));
  if (*name == planning_frame && !pose.isApprox(Eigen::Isometry3d::Identity(), 1e-12))
    child.fail("frame '" + *name + "' is the planning frame; its transform must be the identity");
  if (*name != planning_frame && reader.robot.linkIndex(*name) >= 0)
    child.fail("fixed frame '" + *name + "' has the name of a link");
  if (!reader.fixed_frames.emplace(*name, pose).second)
    child.fail("fixed frame '" + *name + "' is given twice");
}

Eigen::Isometry3d readFrame(const YamlValue* header, SceneReader& reader)
{
  const YamlValue* value = frameOf(header);
  if (!value)
    return Eigen::Isometry3d::Identity();
  // Old tf1 names begin with a slash, and so do the links of some robots. So the name is tried as written, then without
  // the slash.
  for (const std::string& frame : {value->text(), withoutLeadingSlash(value->text())})
  {
    if (frame == reader.robot.planningFrame())
      return Eigen::Isometry3d::Identity();
    const auto fixed = reader.fixed_frames.find(frame);
    if (fixed != reader.fixed_frames.end())
      return fixed->second;
    const int link = reader.robot.linkIndex(frame);
    if (link < 0)
      continue;
    if (reader.state.empty())
      value->fail("frame '" + frame + "' is a link; the file must give the robot_state that places this link");
    reader.has_link_frames = true;
    std::vector<Eigen::Isometry3d> poses(reader.robot.links().size());
    reader.robot.linkPoses(reader.state.data(), poses.data());
    return poses[link];
  }
  value->fail("unknown frame '" + value->text() + "'; known are the planning frame '" + reader.robot.planningFrame() +
              "', the robot's links and the file's fixed_frame_transforms");
}
}  // namespace gpu_planning_scene::core
