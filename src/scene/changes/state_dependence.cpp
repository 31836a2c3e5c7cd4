#include "scene/changes/state_dependence.h"

#include <algorithm>
#include <string>

#include "scene/frame.h"

namespace gpu_planning_scene::core
{
namespace
{
bool isFrameOfRobot(const PlanningScene& scene, const std::string& frame)
{
  if (frame.empty() || isPlanningFrame(*scene.robot, frame))
    return false;
  const std::string name = withoutLeadingSlash(frame);
  return scene.robot->linkIndex(frame) >= 0 || scene.robot->linkIndex(name) >= 0 ||
         std::any_of(scene.attached.begin(), scene.attached.end(),
                     [&](const AttachedObject& attached)
                     {
                       const std::string& id = attached.object.id;
                       return name == id || frame == id || name.rfind(id + "/", 0) == 0;
                     });
}
}  // namespace

bool dependsOnRobotState(const PlanningScene& scene, const SceneChange& change)
{
  const auto is_carried_by_state = [](const AttachedChange& attached)
  {
    const bool is_in_link = withoutLeadingSlash(attached.object.frame.name) == withoutLeadingSlash(attached.link);
    return !(is_in_link && attached.object.operation == Operation::Add && !attached.object.shapes.empty());
  };
  const auto is_placed_by_state = [&scene](const ObjectChange& object)
  { return object.operation != Operation::Remove && isFrameOfRobot(scene, object.frame.name); };
  return std::any_of(change.state.attached.begin(), change.state.attached.end(), is_carried_by_state) ||
         std::any_of(change.objects.begin(), change.objects.end(), is_placed_by_state);
}
}  // namespace gpu_planning_scene::core
