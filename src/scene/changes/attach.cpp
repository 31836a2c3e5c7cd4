#include "scene/changes/attach.h"

#include <algorithm>
#include <utility>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "scene/frame.h"
#include "scene/missing_link.h"
#include "scene/validate_scene.h"

// Attaching objects to links, and detaching them.
namespace gpu_planning_scene::core
{
void requireNotOctomap(const std::string& id)
{
  if (id == kOctomapId)
    throw Error("object '" + id + "' is the octomap, which cannot be attached; leave it in the world");
}

void requireAttachable(const WorldObject& object)
{
  if (hasHalfSpace(object.shapes))
    throw Error("object '" + object.id + "' has a half-space and cannot be attached; leave it in the world");
}

AttachedObject attachedFromWorld(const RobotModel& robot, const WorldObject& object, int link, const double* state)
{
  AttachedObject attached;
  attached.link = link;
  attached.object = object;
  attached.object.pose = linkPose(robot, link, state).inverse() * object.pose;
  return attached;
}

WorldObject detachedToWorld(const RobotModel& robot, AttachedObject attached, const double* state)
{
  attached.object.pose = linkPose(robot, attached.link, state) * attached.object.pose;
  return std::move(attached.object);
}

void addTouchLinks(const RobotModel& robot, const std::vector<std::string>& names, AttachedObject& attached,
                   std::vector<std::string>* warnings)
{
  std::vector<int>& links = attached.touch_links;
  for (const std::string& name : names)
  {
    const std::string where = "touch link of object '" + attached.object.id + "'";
    if (warnings != nullptr && robot.linkIndex(name) < 0)
    {
      warnings->push_back(where + " ignored: the robot " + noLinkText(robot, name));
      continue;
    }
    const int link = requireLink(robot, name, where);
    if (std::find(links.begin(), links.end(), link) == links.end())
      links.push_back(link);
  }
}

void PlanningScene::attach(const std::string& object, const std::string& link,
                           const std::vector<std::string>& touch_links, const double* state)
{
  const auto found =
      std::find_if(objects.begin(), objects.end(), [&](const WorldObject& known) { return known.id == object; });
  if (found == objects.end())
  {
    if (const AttachedObject* known = findAttached(object))
      throw Error("object '" + object + "' is attached to link '" + robot->links().at(known->link).name +
                  "' already; detach it first");
    throw Error("object '" + object + "' cannot be attached: the scene has no such object");
  }
  requireNotOctomap(object);
  requireAttachable(*found);
  const int index = requireLink(*robot, link, "object '" + object + "' cannot be attached");
  AttachedObject added = attachedFromWorld(*robot, *found, index, state);
  addTouchLinks(*robot, touch_links, added, nullptr);
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
  objects.push_back(detachedToWorld(*robot, *found, state));
  attached.erase(found);
}
}  // namespace gpu_planning_scene::core
