#include "scene/frame.h"

#include <algorithm>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
/// OBJECT/SUBFRAME; both names may contain slashes.
std::optional<LocatedFrame> locateSubframe(const KnownFrames& known, const std::string& name)
{
  for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1))
  {
    const std::optional<ObjectFrame> object = known.object(name.substr(0, slash));
    if (!object)
      continue;
    const auto subframe = object->subframes->find(name.substr(slash + 1));
    if (subframe != object->subframes->end())
      return LocatedFrame{object->link, *object->pose, subframe->second};
  }
  return std::nullopt;
}

std::optional<LocatedFrame> locateAsWritten(const KnownFrames& known, const std::string& name)
{
  if (name.empty() || name == known.robot.planningFrame())
    return LocatedFrame{};
  if (const int link = known.robot.linkIndex(name); link >= 0)
    return LocatedFrame{link};
  if (const std::optional<ObjectFrame> object = known.object(name))
    return LocatedFrame{object->link, *object->pose};
  if (auto subframe = locateSubframe(known, name))
    return subframe;
  const auto fixed = known.fixed_frames.find(name);
  return fixed == known.fixed_frames.end() ? std::nullopt : std::make_optional(LocatedFrame{-1, fixed->second});
}

/// Old tf1 names begin with a slash, and so do the links of some robots. So the name is tried as written, then without
/// the slash.
std::optional<LocatedFrame> locate(const KnownFrames& known, const std::string& name)
{
  const auto located = locateAsWritten(known, name);
  return located || name.empty() || name[0] != '/' ? located : locateAsWritten(known, name.substr(1));
}

KnownFrames framesOf(const PlanningScene& scene)
{
  const auto find_object = [&scene](const std::string& id) -> std::optional<ObjectFrame>
  {
    if (const AttachedObject* attached = scene.findAttached(id))
      return ObjectFrame{&attached->object.pose, &attached->object.subframes, attached->link};
    if (const WorldObject* object = scene.findObject(id))
      return ObjectFrame{&object->pose, &object->subframes};
    return std::nullopt;
  };
  return {*scene.robot, scene.fixed_frames, find_object};
}
}  // namespace

Eigen::Isometry3d linkPose(const RobotModel& robot, int link, const double* state)
{
  const std::string& name = robot.links()[static_cast<std::size_t>(link)].name;
  if (state == nullptr)
    throw NotKnownYet("the robot's state is not known yet, so link '" + name +
                      "' has no pose; give the joints' values first");
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  robot.linkPoses(state, poses.data());
  if (!poses[static_cast<std::size_t>(link)].matrix().allFinite())
    throw Error("the robot state is not finite, so link '" + name + "' has no pose");
  return poses[static_cast<std::size_t>(link)];
}

std::string withoutLeadingSlash(const std::string& frame)
{
  return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame;
}

bool isPlanningFrame(const RobotModel& robot, const std::string& frame)
{
  if (withoutLeadingSlash(frame) == withoutLeadingSlash(robot.planningFrame()))
    return true;
  int link = std::max(robot.linkIndex(frame), robot.linkIndex(withoutLeadingSlash(frame)));
  if (link < 0)
    return false;
  while (link >= 0 && robot.links()[static_cast<std::size_t>(link)].parent_joint >= 0)
  {
    const Joint& joint =
        robot.joints()[static_cast<std::size_t>(robot.links()[static_cast<std::size_t>(link)].parent_joint)];
    if (joint.type != JointType::Fixed || joint.origin.matrix() != Eigen::Matrix4d::Identity())
      return false;
    link = joint.parent_link;
  }
  return true;
}

std::optional<std::string> fixedFrameName(const std::string& frame_id, const std::string& child_frame_id,
                                          const std::string& planning_frame)
{
  const auto is_planning_frame = [&planning_frame](const std::string& name)
  { return withoutLeadingSlash(name) == withoutLeadingSlash(planning_frame); };
  if (is_planning_frame(child_frame_id))
    return frame_id.empty() || is_planning_frame(frame_id) ? planning_frame : frame_id;
  if (frame_id.empty() || is_planning_frame(frame_id))
    return child_frame_id;
  return std::nullopt;
}

std::optional<Eigen::Isometry3d> findFrame(const KnownFrames& known, const std::string& name, const double* state)
{
  const std::optional<LocatedFrame> located = locate(known, name);
  if (!located)
    return std::nullopt;
  if (located->link < 0)
    return located->object * located->subframe;
  return linkPose(known.robot, located->link, state) * located->object * located->subframe;
}

std::optional<LocatedFrame> locateFrame(const PlanningScene& scene, const std::string& name)
{
  return locate(framesOf(scene), name);
}

std::vector<std::string> frameNames(const PlanningScene& scene)
{
  std::vector<std::string> names = {scene.robot->planningFrame()};
  for (const Link& link : scene.robot->links())
    names.push_back(link.name);
  const auto add = [&names](const WorldObject& object)
  {
    names.push_back(object.id);
    for (const auto& [subframe, pose] : object.subframes)
      names.push_back(object.id + "/" + subframe);
  };
  for (const WorldObject& object : scene.objects)
    add(object);
  for (const AttachedObject& attached : scene.attached)
    add(attached.object);
  for (const auto& [name, pose] : scene.fixed_frames)
    names.push_back(name);
  return names;
}

std::optional<Eigen::Isometry3d> PlanningScene::frame(const std::string& frame_name, const double* state) const
{
  return findFrame(framesOf(*this), frame_name, state);
}
}  // namespace gpu_planning_scene::core
