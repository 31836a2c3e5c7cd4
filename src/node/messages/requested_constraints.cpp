#include "node/messages/requested_constraints.h"

#include <algorithm>

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
                                              const std::string& group, const double* state,
                                              const PoseReader::Lookup& lookup)
{
  if (message.joint_constraints.empty() && message.position_constraints.empty() &&
      message.orientation_constraints.empty())
    return {};
  if (group.empty())
    throw Error("path_constraints need the group that moves; give `group`");
  PoseReader reader(scene, state, lookup);
  ConstraintFrames frames = constraintFrames(reader, scene);
  const std::vector<int>& moved = scene.robot->group(group).moved_links;
  frames.pose = [&, of_reader = frames.pose](const StampedFrame& frame)
  {
    const auto located = locateFrame(scene, frame.name);
    if (located && located->link >= 0 && std::binary_search(moved.begin(), moved.end(), located->link))
      throw Error("path_constraints: the frame '" + frame.name + "' moves with the group '" + group +
                  "'; give the constraints in a frame that stands still during the motion");
    return of_reader(frame);
  };
  return constraintsFrom(message, *scene.robot, frames, "path_constraints");
}
}  // namespace gpu_planning_scene::core
