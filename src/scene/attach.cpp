#include <algorithm>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning_scene.h"
#include "scene/frame.h"
#include "scene/missing_link.h"
#include "scene/validate_scene.h"

// Attaching objects to links, and detaching them.
namespace gpu_planning_scene::core
{
namespace
{
int requireLink(const RobotModel& robot, const std::string& name, const std::string& where)
{
  const int link = robot.linkIndex(name);
  if (link < 0)
    throw Error(where + ": robot '" + robot.name() + "' " + noLinkText(robot, name));
  return link;
}
}  // namespace

void PlanningScene::attach(const std::string& object, const std::string& link,
                           const std::vector<std::string>& touch_links, const double* state)
{
  const auto found =
      std::find_if(objects.begin(), objects.end(), [&](const WorldObject& known) { return known.id == object; });
  if (found == objects.end())
  {
    for (const AttachedObject& known : attached)
      if (known.object.id == object)
        throw Error("object '" + object + "' is attached to link '" + robot->links().at(known.link).name +
                    "' already; detach it first");
    throw Error("object '" + object + "' cannot be attached: the scene has no such object");
  }
  if (hasHalfSpace(found->shapes))
    throw Error("object '" + object + "' has a half-space and cannot be attached; leave it in the world");
  AttachedObject added;
  added.link = requireLink(*robot, link, "object '" + object + "' cannot be attached");
  for (const std::string& touch_link : touch_links)
    added.touch_links.push_back(requireLink(*robot, touch_link, "touch link of object '" + object + "'"));
  added.object = *found;
  added.object.pose = linkPose(*robot, added.link, state).inverse() * found->pose;
  scaleAttached(added);
  attached.push_back(std::move(added));
  objects.erase(found);
}

void PlanningScene::detach(const std::string& object, const double* state)
{
  const auto found = std::find_if(attached.begin(), attached.end(),
                                  [&](const AttachedObject& known) { return known.object.id == object; });
  if (found == attached.end())
    throw Error("object '" + object + "' cannot be detached: no such object is attached");
  WorldObject freed = found->object;
  freed.pose = linkPose(*robot, found->link, state) * found->object.pose;
  objects.push_back(std::move(freed));
  attached.erase(found);
}
}  // namespace gpu_planning_scene::core
