#include <algorithm>

#include "gpu_planning_scene/error.h"
#include "scene/frame.h"
#include "scene/scene_changer.h"
#include "scene/validate_scene.h"

// Attached objects: attaching them, appending to them, detaching them.

namespace gpu_planning_scene::core
{
void SceneChanger::changeAttached(const AttachedChange& change)
{
  const std::string& id = change.object.id;
  if (change.object.operation == Operation::Remove)
  {
    detach(change);
    return;
  }
  requireNewId(id);
  require(change.object);
  if (change.object.operation == Operation::Move)
    throw Error("attached object '" + id + "' cannot be moved; attach it again with its shapes");
  AttachedObject* const carried = attached_.find(id);
  if (change.object.operation == Operation::Append && carried != nullptr)
    appendToCarried(*carried, change);
  else
    attach(change);
  attached_here_.insert(id);
}

void SceneChanger::attach(const AttachedChange& change)
{
  const std::string& id = change.object.id;
  const int link = requireLink(change.link, "object '" + id + "' cannot be attached");
  AttachedObject carried = change.object.shapes.empty() ? fromWorld(change, link) : fromShapes(change, link);
  if (hasHalfSpace(carried.object.shapes))
    throw Error("object '" + id + "' has a half-space and cannot be attached; leave it in the world");
  addTouchLinks(change, carried);
  carried.padding = defaults_.attached_padding;
  result_.scene.scaleCarried(carried);
  warnOfAllowedCollisions(id);

  if (objects_.find(id) != nullptr)
    count_.remove(objects_.take(id).shapes);
  AttachedObject* const known = attached_.find(id);
  if (known != nullptr)
    count_.remove(known->object.shapes);
  count_.add(id, carried.object.shapes);
  if (known != nullptr)
    *known = std::move(carried);
  else
    attached_.add(std::move(carried));
}

AttachedObject SceneChanger::fromWorld(const AttachedChange& change, int link)
{
  const std::string& id = change.object.id;
  const std::string where = "object '" + id + "' cannot be attached: ";
  if (const AttachedObject* const known = attached_.find(id))
    throw Error(where + "it is attached to link '" + linkName(known->link) +
                "' already; detach it first, or give its shapes to replace it");
  const WorldObject* const object = objects_.find(id);
  if (object == nullptr)
    throw Error(where + "the scene has no such object; add it first, or give its shapes");
  if (change.object.pose)
    result_.warnings.push_back("object '" + id +
                               "' is attached at its place in the world; the pose in the request is not used");
  AttachedObject carried;
  carried.link = link;
  carried.object = *object;
  carried.object.pose = linkPose(*result_.scene.robot, link, knownState()).inverse() * object->pose;
  appendShapes(change.object, carried.object);
  return carried;
}

AttachedObject SceneChanger::fromShapes(const AttachedChange& change, int link)
{
  AttachedObject carried;
  carried.link = link;
  carried.object = newObject(change.object);
  carried.object.pose = poseInLink(carried.object.pose, change.object.frame, link);
  return carried;
}

void SceneChanger::appendToCarried(AttachedObject& carried, const AttachedChange& change)
{
  if (!change.link.empty() && requireLink(change.link, "object '" + change.object.id + "'") != carried.link)
    throw Error("object '" + change.object.id + "' is attached to link '" + linkName(carried.link) + "', not to '" +
                change.link + "'; name that link, or none, to append to it");
  if (change.object.pose)
    carried.object.pose = poseInLink(*change.object.pose, change.object.frame, carried.link);
  count_.remove(carried.object.shapes);
  appendShapes(change.object, carried.object);
  if (hasHalfSpace(carried.object.shapes))
    throw Error("object '" + change.object.id + "' is attached and cannot have a half-space");
  count_.add(change.object.id, carried.object.shapes);
  addTouchLinks(change, carried);
  result_.scene.scaleCarried(carried);
}

void SceneChanger::addTouchLinks(const AttachedChange& change, AttachedObject& carried) const
{
  std::vector<int>& links = carried.touch_links;
  for (const std::string& name : change.touch_links)
  {
    const int link = requireLink(name, "touch link of object '" + change.object.id + "'");
    if (std::find(links.begin(), links.end(), link) == links.end())
      links.push_back(link);
  }
}

/// A pose in the link's own frame does not need the state of the robot.
Eigen::Isometry3d SceneChanger::poseInLink(const Eigen::Isometry3d& pose, const FrameAt& frame, int link)
{
  if (frame.name == linkName(link) || frame.name == "/" + linkName(link))
    return pose;
  return linkPose(*result_.scene.robot, link, knownState()).inverse() * placed(pose, frame);
}

void SceneChanger::detach(const AttachedChange& change)
{
  const std::string& id = change.object.id;
  const std::string where = "object '" + id + "' cannot be detached: ";
  const int link = change.link.empty() ? -1 : requireLink(change.link, id.empty() ? "attached objects" : where);
  if (id.empty())
  {
    for (const std::string& carried : attached_.ids())
      if (link < 0 || attached_.find(carried)->link == link)
        putBack(carried);
    return;
  }
  const AttachedObject* const carried = attached_.find(id);
  if (carried == nullptr)
    throw Error(where + "no such object is attached");
  if (link >= 0 && carried->link != link)
    throw Error(where + "it is attached to link '" + linkName(carried->link) + "', not to '" + change.link +
                "'; name that link, or none");
  putBack(id);
}

void SceneChanger::putBack(const std::string& id)
{
  AttachedObject carried = attached_.take(id);
  carried.object.pose = linkPose(*result_.scene.robot, carried.link, knownState()) * carried.object.pose;
  objects_.add(std::move(carried.object));
  attached_here_.erase(id);
}
}  // namespace gpu_planning_scene::core
