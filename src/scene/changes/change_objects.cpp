#include <algorithm>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "scene/changes/scene_changer.h"

// Objects of the world: adding, appending to, moving and removing them.
namespace gpu_planning_scene::core
{
void SceneChanger::clearWorld(bool keeps_octomap, bool keeps_settings)
{
  for (const std::string& id : objects_.ids())
  {
    if (id == kOctomapId && keeps_octomap)
      continue;
    count_.remove(objects_.take(id).shapes);
    if (!keeps_settings)
      forget(id);
  }
}

/// As in MoveIt, a scene whose is_diff is false replaces the world. Clients often leave is_diff unset by mistake.
void SceneChanger::warnOfLostObjects(const SceneChange& change)
{
  std::vector<std::string> lost;
  for (const std::string& id : objects_.ids())
  {
    const auto is_it = [&id](const ObjectChange& object) { return object.id == id; };
    const bool is_attached = std::any_of(change.state.attached.begin(), change.state.attached.end(),
                                         [&](const AttachedChange& attached) { return is_it(attached.object); });
    if (!is_attached && std::none_of(change.objects.begin(), change.objects.end(), is_it))
      lost.push_back("'" + id + "'");
  }
  if (!lost.empty())
    result_.warnings.push_back("removed because the scene's is_diff is false, which replaces the world: " +
                               nameList(lost));
}

void SceneChanger::changeObject(const ObjectChange& change)
{
  if (change.operation == Operation::Remove)
  {
    if (change.id.empty())
      clearWorld(true, change.keeps_allowed_collisions);
    else
      removeObject(change);
    return;
  }
  if (change.id == kOctomapId && change.operation != Operation::Add)
    throw Error("the octomap can only be added, which replaces it, and removed");
  requireNewId(change.id);
  if (const AttachedObject* attached = attached_.find(change.id))
    throw Error("object '" + change.id + "' is attached to link '" + linkName(attached->link) +
                "'; change it as an attached object, or detach it first");
  require(change);
  WorldObject* const known = objects_.find(change.id);
  if (change.operation == Operation::Move)
    moveObject(change);
  else if (change.operation == Operation::Append && known != nullptr)
    appendToObject(*known, change);
  else
    addObject(change);
}

void SceneChanger::addObject(const ObjectChange& change)
{
  WorldObject object = newObject(change);
  object.pose = placed(object.pose, change.frame);
  warnOfAllowedCollisions(change.id);
  WorldObject* const known = objects_.find(change.id);
  if (known != nullptr)
    count_.remove(known->shapes);
  count_.add(change.id, object.shapes);
  if (known != nullptr)
    *known = std::move(object);
  else
    objects_.add(std::move(object));
}

/// MoveIt ignores the frame and the pose of an append without a warning. Here they are refused if they differ from the
/// object's. The identity counts as no pose, because clients that fill in a quaternion send it.
void SceneChanger::appendToObject(WorldObject& object, const ObjectChange& change)
{
  const std::string where =
      "cannot append to object '" + change.id + "': its pose cannot change, and poses of shapes must be ";
  const bool has_pose = change.pose && !change.pose->isApprox(Eigen::Isometry3d::Identity(), 1e-12);
  if (has_pose && !placed(*change.pose, change.frame).isApprox(object.pose, 1e-9))
    throw Error(where + "in its own frame; leave the object's pose out");
  if (!has_pose && !isPlanningFrame(change.frame.name) && change.frame.name != change.id)
    throw Error(where + "in its own frame, not in '" + change.frame.name + "'; leave frame_id out");
  count_.remove(object.shapes);
  appendShapes(change, object);
  count_.add(change.id, object.shapes);
}

void SceneChanger::moveObject(const ObjectChange& change)
{
  const std::string where = "object '" + change.id + "' cannot be moved: ";
  WorldObject* const object = objects_.find(change.id);
  if (object == nullptr)
    throw Error(where + "the scene has no such object");
  if (!change.shapes.empty())
    throw Error(where + "a move changes only poses; leave the shapes out, or add the object to replace it");
  std::vector<PlacedShape>& shapes = object->shapes;
  if (!change.shape_poses.empty() && change.shape_poses.size() != shapes.size())
    throw Error(where + std::to_string(change.shape_poses.size()) + " poses for its " + std::to_string(shapes.size()) +
                " shapes");
  const bool has_lone_pose = !change.pose && change.shape_poses.size() == 1;
  const Eigen::Isometry3d none = Eigen::Isometry3d::Identity();
  // The new pose is computed before the object changes, because `frame` may be the object's own.
  object->pose = placed(has_lone_pose ? change.shape_poses.front() : change.pose.value_or(none), change.frame);
  for (std::size_t i = 0; i < change.shape_poses.size(); ++i)
    shapes[i].pose = has_lone_pose ? none : change.shape_poses[i];
  for (const auto& [name, pose] : change.subframes)
    object->subframes[name] = pose;
  if (!change.type.isEmpty())
    object->type = change.type;
}

/// MoveIt's tutorials attach an object and remove it from the world in one change. This removal is not an error.
void SceneChanger::removeObject(const ObjectChange& change)
{
  const std::string& id = change.id;
  if (objects_.find(id) != nullptr)
  {
    count_.remove(objects_.take(id).shapes);
    if (!change.keeps_allowed_collisions)
      forget(id);
    else if (id != kOctomapId)
      result_.scene.colors.erase(id);
    return;
  }
  if (attached_here_.count(id) != 0 || id == kOctomapId)
    return;
  const AttachedObject* const attached = attached_.find(id);
  throw Error("object '" + id + "' cannot be removed: " +
              (attached != nullptr ? "it is attached to link '" + linkName(attached->link) + "'; detach it first"
                                   : "the scene has no such object"));
}
}  // namespace gpu_planning_scene::core
