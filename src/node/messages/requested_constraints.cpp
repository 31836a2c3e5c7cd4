#include "node/messages/requested_constraints.h"

#include <algorithm>
#include <optional>

#include "gpu_planning_scene/error.h"
#include "scene/frame.h"

namespace gpu_planning_scene::core
{
ConstraintFrames constraintFrames(PoseReader& reader, const PlanningScene& scene)
{
  return {[&reader](const StampedFrame& frame) { return reader.frame(frame); },
          [&scene](const std::string& name)
          {
            if (name.empty())
              throw Error("link_name is empty; name a link, a carried object, or OBJECT/SUBFRAME");
            return linkFrame(scene, name);
          }};
}

KinematicConstraints requestedPathConstraints(const Constraints& message, const PlanningScene& scene,
                                              const std::string& group, const double* state, const OtherFrames& others)
{
  if (message.joint_constraints.empty() && message.position_constraints.empty() &&
      message.orientation_constraints.empty())
    return {};
  if (group.empty())
    throw Error("path_constraints need the group that moves; give `group`");
  PoseReader reader(scene, state, others.pose);
  ConstraintFrames frames = constraintFrames(reader, scene);
  const RobotModel& robot = *scene.robot;
  const std::vector<int>& moved = robot.group(group).moved_links;
  const auto require_unmoved = [&](int link, const StampedFrame& frame, const std::string& why)
  {
    if (link >= 0 && std::binary_search(moved.begin(), moved.end(), link))
      throw Error("path_constraints: the frame '" + frame.name + "' moves with the group '" + group + "'" + why +
                  "; give the constraints in a frame that stands still during the motion");
  };
  frames.pose = [&, of_reader = frames.pose](const StampedFrame& frame)
  {
    const std::optional<LocatedFrame> located = locateFrame(scene, frame.name);
    if (located)
      require_unmoved(located->link, frame, "");
    Eigen::Isometry3d pose = of_reader(frame);  // after it, the parents of the frame are known
    if (!located && others.parents)
      for (const std::string& parent : others.parents(frame.name))
        require_unmoved(robot.linkIndex(parent), frame, ", because it hangs on the link '" + parent + "'");
    return pose;
  };
  return constraintsFrom(message, robot, frames, "path_constraints");
}
}  // namespace gpu_planning_scene::core
