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
  AttachedObject* const attached = attached_.find(id);
  if (change.object.operation == Operation::Append && attached != nullptr)
    appendToAttached(*attached, change);
  else
    attach(change);
  attached_here_.insert(id);
}

void SceneChanger::attach(const AttachedChange& change)
{
  const std::string& id = change.object.id;
  const int link = requireLink(change.link, "object '" + id + "' cannot be attached");
  AttachedObject attached = change.object.shapes.empty() ? fromWorld(change, link) : fromShapes(change, link);
  if (hasHalfSpace(attached.object.shapes))
    throw Error("object '" + id + "' has a half-space and cannot be attached; leave it in the world");
  addTouchLinks(change, attached);
  attached.padding = defaults_.attached_padding;
  result_.scene.scaleAttached(attached);
  warnOfAllowedCollisions(id);

  if (objects_.find(id) != nullptr)
    count_.remove(objects_.take(id).shapes);
  AttachedObject* const known = attached_.find(id);
  if (known != nullptr)
    count_.remove(known->object.shapes);
  count_.add(id, attached.object.shapes);
  if (known != nullptr)
    *known = std::move(attached);
  else
    attached_.add(std::move(attached));
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
  AttachedObject attached;
  attached.link = link;
  attached.object = *object;
  attached.object.pose = linkPose(*result_.scene.robot, link, knownState()).inverse() * object->pose;
  appendShapes(change.object, attached.object);
  return attached;
}

AttachedObject SceneChanger::fromShapes(const AttachedChange& change, int link)
{
  AttachedObject attached;
  attached.link = link;
  attached.object = newObject(change.object);
  attached.object.pose = poseInLink(attached.object.pose, change.object.frame, link);
  return attached;
}

void SceneChanger::appendToAttached(AttachedObject& attached, const AttachedChange& change)
{
  if (!change.link.empty() && requireLink(change.link, "object '" + change.object.id + "'") != attached.link)
    throw Error("object '" + change.object.id + "' is attached to link '" + linkName(attached.link) + "', not to '" +
                change.link + "'; name that link, or none, to append to it");
  if (change.object.pose)
    attached.object.pose = poseInLink(*change.object.pose, change.object.frame, attached.link);
  count_.remove(attached.object.shapes);
  appendShapes(change.object, attached.object);
  if (hasHalfSpace(attached.object.shapes))
    throw Error("object '" + change.object.id + "' is attached and cannot have a half-space");
  count_.add(change.object.id, attached.object.shapes);
  addTouchLinks(change, attached);
  result_.scene.scaleAttached(attached);
}

void SceneChanger::addTouchLinks(const AttachedChange& change, AttachedObject& attached) const
{
  std::vector<int>& links = attached.touch_links;
  for (const std::string& name : change.touch_links)
  {
    const int link = requireLink(name, "touch link of object '" + change.object.id + "'");
    if (std::find(links.begin(), links.end(), link) == links.end())
      links.push_back(link);
  }
}

/// A pose in the link's own frame does not need the state of the robot.
Eigen::Isometry3d SceneChanger::poseInLink(const Eigen::Isometry3d& pose, const StampedFrame& frame, int link)
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
    for (const std::string& attached_id : attached_.ids())
      if (link < 0 || attached_.find(attached_id)->link == link)
        detachToWorld(attached_id);
    return;
  }
  const AttachedObject* const attached = attached_.find(id);
  if (attached == nullptr)
    throw Error(where + "no such object is attached");
  if (link >= 0 && attached->link != link)
    throw Error(where + "it is attached to link '" + linkName(attached->link) + "', not to '" + change.link +
                "'; name that link, or none");
  detachToWorld(id);
}

void SceneChanger::detachToWorld(const std::string& id)
{
  AttachedObject attached = attached_.take(id);
  attached.object.pose = linkPose(*result_.scene.robot, attached.link, knownState()) * attached.object.pose;
  objects_.add(std::move(attached.object));
  attached_here_.erase(id);
}
}  // namespace gpu_planning_scene::core
