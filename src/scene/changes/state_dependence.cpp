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
  return !change.state.attached.empty() ||
         std::any_of(
             change.objects.begin(), change.objects.end(),
             [&scene](const ObjectChange& object) { return isFrameOfRobot(scene, object.frame.name); });
}
}  // namespace gpu_planning_scene::core
