#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// The pose of a link in the planning frame. Throws NotKnownYet if `state` is null, and Error if it is not finite.
Eigen::Isometry3d linkPose(const RobotModel& robot, int link, const double* state);

/// The frame of an object, with its subframes.
struct ObjectFrame
{
  const Eigen::Isometry3d* pose;
  const std::map<std::string, Eigen::Isometry3d>* subframes;
  int link = -1;  ///< the link that carries the object, in whose frame `pose` is; -1: `pose` is in the planning frame
};

/// The frames of a scene in which PlanningScene::frame looks up names.
struct KnownFrames
{
  const RobotModel& robot;
  const std::map<std::string, Eigen::Isometry3d>& fixed_frames;
  std::function<std::optional<ObjectFrame>(const std::string& id)> object;
};

/// Where a frame is: in the frame of a link, or in the planning frame (link -1).
struct LocatedFrame
{
  int link = -1;
  Eigen::Isometry3d object = Eigen::Isometry3d::Identity();    ///< of the object (or fixed frame), in the frame above
  Eigen::Isometry3d subframe = Eigen::Isometry3d::Identity();  ///< in the object's frame
};

/// Looks up a name as PlanningScene::frame. It needs no robot state. No value: the scene has no frame of this name.
std::optional<LocatedFrame> locateFrame(const PlanningScene& scene, const std::string& name);

/// A name of tf1 begins with a slash.
std::string withoutLeadingSlash(const std::string& frame);

/// The frame whose pose in the planning frame an entry of `fixed_frame_transforms` gives. MoveIt writes its name as
/// `frame_id` and the planning frame as `child_frame_id`; tf has it the other way round. Both are accepted, and an
/// empty `frame_id` is the planning frame. No value: neither name is the planning frame.
std::optional<std::string> fixedFrameName(const std::string& frame_id, const std::string& child_frame_id,
                                          const std::string& planning_frame);

/// Whether a frame coincides with the planning frame in all states: it has its name, or is a link that fixed joints
/// without an offset connect to it, such as the root link under a fixed virtual joint.
bool isPlanningFrame(const RobotModel& robot, const std::string& frame);

/// The names that PlanningScene::frame knows, without slashes that may precede them.
std::vector<std::string> frameNames(const PlanningScene& scene);

/// See PlanningScene::frame.
std::optional<Eigen::Isometry3d> findFrame(const KnownFrames& known, const std::string& name, const double* state);
}  // namespace gpu_planning_scene::core
