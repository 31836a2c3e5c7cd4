#include <algorithm>
#include <cmath>
#include <optional>

#include "gpu_planning_scene/error.h"
#include "scene/changes/attach.h"
#include "scene/changes/scene_changer.h"
#include "scene/frame.h"
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
  requireNotOctomap(id);
  requireNewId(id);
  require(change.object);
  requireLoad(change);
  if (change.object.operation == Operation::Move)
    throw Error("attached object '" + id + "' cannot be moved; attach it again with its shapes");
  AttachedObject* const attached = attached_.find(id);
  if (change.object.operation == Operation::Append && attached != nullptr)
    appendToAttached(*attached, change);
  else
    attach(change);
  attached_here_.insert(id);
}

/// Weight and posture change no verdict, so only their size is limited.
void SceneChanger::requireLoad(const AttachedChange& change) const
{
  const std::string where = "object '" + change.object.id + "'";
  if (!(change.weight >= 0.0) || std::isinf(change.weight))
    throw Error(where + ": the weight is " + std::to_string(change.weight) + "; it must be a number of at least 0");
  count_.requirePosture(change.detach_posture, where);
}

void SceneChanger::attach(const AttachedChange& change)
{
  const std::string& id = change.object.id;
  const int link = linkIndex(change.link, "object '" + id + "' cannot be attached");
  AttachedObject attached = change.object.shapes.empty() ? fromWorld(change, link) : fromShapes(change, link);
  requireAttachable(attached.object);
  attached.detach_posture = change.detach_posture;
  attached.weight = change.weight;
  addTouchLinks(*result_.scene.robot, change.touch_links, attached, &result_.warnings);
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
  AttachedObject attached = attachedFromWorld(*result_.scene.robot, *object, link, knownState());
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
  if (!change.link.empty() && linkIndex(change.link, "object '" + change.object.id + "'") != attached.link)
    throw Error("object '" + change.object.id + "' is attached to link '" + linkName(attached.link) + "', not to '" +
                change.link + "'; name that link, or none, to append to it");
  if (change.object.pose)
    attached.object.pose = poseInLink(*change.object.pose, change.object.frame, attached.link);
  count_.remove(attached.object.shapes);
  appendShapes(change.object, attached.object);
  if (hasHalfSpace(attached.object.shapes))
    throw Error("object '" + change.object.id + "' is attached and cannot have a half-space");
  count_.add(change.object.id, attached.object.shapes);
  if (!change.detach_posture.joint_names.empty())
    attached.detach_posture = change.detach_posture;
  if (change.weight != 0.0)
    attached.weight = change.weight;
  addTouchLinks(*result_.scene.robot, change.touch_links, attached, &result_.warnings);
  result_.scene.scaleAttached(attached);
}

void SceneChanger::warnOfForbiddenCarrier(const AttachedObject& attached)
{
  const std::string& id = attached.object.id;
  const std::string& link = linkName(attached.link);
  const std::vector<int>& touching = attached.touch_links;
  const std::optional<bool> entry = result_.scene.allowed_collisions.entryOf(id, link);
  if (!entry || *entry || std::find(touching.begin(), touching.end(), attached.link) != touching.end())
    return;
  result_.warnings.push_back(
      "the allowed-collision matrix forbids object '" + id + "' to touch link '" + link +
      "', but this pair is not checked, because the link carries the object; to avoid this warning, "
      "list the link in touch_links too");
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
  const int link = change.link.empty() ? -1 : linkIndex(change.link, id.empty() ? "attached objects" : where);
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
  objects_.add(detachedToWorld(*result_.scene.robot, attached_.take(id), knownState()));
  attached_here_.erase(id);
}
}  // namespace gpu_planning_scene::core
