#include "scene/changes/scene_changer.h"

#include <algorithm>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "model/rigid_pose.h"
#include "scene/changes/matrix_entries.h"
#include "scene/changes/octree_cubes.h"
#include "scene/frame.h"
#include "scene/shape_order.h"
#include "scene/solid_rules.h"

// Functions that all parts of a change use.
namespace gpu_planning_scene::core
{
namespace
{
void requirePadding(double padding, const char* which)
{
  if (!(padding >= 0.0) || padding > kLargestLength)
    throw Error(std::string(which) + " is " + std::to_string(padding) + "; it must not be negative, nor above 1000 km");
}
}  // namespace

SceneChanger::SceneChanger(const PlanningScene& scene, const std::vector<double>& state, const SceneDefaults& defaults,
                           const SceneLimits& limits, Lookup lookup)
  : result_{scene, state, {}},
    objects_(result_.scene.objects),
    attached_(result_.scene.attached),
    count_(limits, scene),
    defaults_(defaults),
    lookup_(std::move(lookup))
{
  const std::size_t variables = scene.robot->variables().size();
  if (!state.empty() && state.size() != variables)
    throw Error("the robot state has " + std::to_string(state.size()) + " values for " + std::to_string(variables) +
                " variables; give one per variable, or none");
  requirePadding(defaults.object_padding, "default_object_padding");
  requirePadding(defaults.attached_padding, "default_attached_padding");
}

/// The world of a full scene is emptied first, so that the change cannot attach an object of the previous scene.
ChangedScene SceneChanger::make(const SceneChange& change)
{
  has_new_matrix_ = change.matrix.has_value();
  keeps_matrix_ = change.is_diff && !has_new_matrix_;
  const AllowedCollisionMatrix matrix_before =
      keeps_matrix_ ? AllowedCollisionMatrix() : result_.scene.allowed_collisions;
  changeNames(change);
  if (!change.is_diff)
  {
    warnOfLostObjects(change);
    clearWorld(false, false);
  }
  changeFixedFrames(change);
  changeState(change.state, !change.is_diff);
  changeMatrix(change);
  changePadding(change);
  changeScale(change);
  changeColors(change);
  for (const ObjectChange& object : change.objects)
    changeObject(object);
  changeSolids(change);
  objects_.close();
  attached_.close();
  count_.requireTriangles(result_.scene);
  count_.requireFramesAndColors(result_.scene);
  warnOfMatrixReset(change, matrix_before);
  for (const AttachedObject& attached : result_.scene.attached)
    if (attached_here_.count(attached.object.id) != 0 ||
        (has_new_matrix_ && matrix_before.allowed(attached.object.id, linkName(attached.link))))
      warnOfForbiddenCarrier(attached);
  result_.scene.current_state = result_.state;
  return std::move(result_);
}

void SceneChanger::requireNewId(const std::string& id) const
{
  count_.requireName(id, "collision object");
  if (result_.scene.robot->linkIndex(id) >= 0)
    throw Error("object '" + id + "' has the name of a link; give it another id");
}

void SceneChanger::requirePose(const Eigen::Isometry3d& pose, const std::string& where) const
{
  if (!isRigid(pose))
    throw Error(where + ": a pose is not finite, not a rotation and a translation, or farther than 1000 km away");
}

void SceneChanger::require(const ObjectChange& change)
{
  const std::string where = "object '" + change.id + "'";
  if (change.pose)
    requirePose(*change.pose, where);
  for (const Eigen::Isometry3d& pose : change.shape_poses)
    requirePose(pose, where);
  count_.requireType(change.type, where);
  for (const auto& [name, pose] : change.subframes)
  {
    count_.requireName(name, "subframe of " + where);
    requirePose(pose, where + ", subframe '" + name + "'");
  }
  for (const PlacedShape& placed : change.shapes)
  {
    requirePose(placed.pose, where);
    const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape);
    if (mesh == nullptr || valid_meshes_.count(mesh->get()) == 0)
      validateShape(placed.shape, where);
    if (mesh != nullptr)
      valid_meshes_.insert(mesh->get());
  }
  if (change.id == kOctomapId)
  {
    count_.requireVoxels(change.shapes.size());
    requireOctree(change.shapes);
  }
}

void SceneChanger::forget(const std::string& id)
{
  if (id == kOctomapId)
    return;
  result_.scene.colors.erase(id);
  if (!keeps_matrix_)
    return;
  for (std::string& warning : removeEntriesOfObject(result_.scene.allowed_collisions, id))
    result_.warnings.push_back(std::move(warning));
}

void SceneChanger::warnOfAllowedCollisions(const std::string& id)
{
  const AllowedCollisionMatrix& matrix = result_.scene.allowed_collisions;
  if (id == kOctomapId || has_new_matrix_ || objects_.find(id) != nullptr || attached_.find(id) != nullptr)
    return;
  const std::vector<std::string> partners = matrix.allowedPartners(id);
  if (partners.empty() && !matrix.defaultOf(id).value_or(false))
    return;
  result_.warnings.push_back(
      "object '" + id + "' is new, and the allowed-collision matrix lets it touch " +
      (partners.empty() ? "all bodies by default"
                        : "'" + partners.front() + "'" +
                              (partners.size() == 1 ? "" : " and " + std::to_string(partners.size() - 1) + " more")) +
      "; set a new matrix if these entries were meant for an earlier object of that id");
}

WorldObject SceneChanger::newObject(const ObjectChange& change) const
{
  if (change.shapes.empty())
    throw Error("object '" + change.id + "' has no shapes; give it primitives, meshes or planes");
  WorldObject object;
  object.id = change.id;
  object.padding = defaults_.object_padding;
  appendShapes(change, object);
  if (change.pose)
    object.pose = *change.pose;
  else if (object.shapes.size() == 1)
    std::swap(object.pose, object.shapes.front().pose);
  return object;
}

Eigen::Isometry3d SceneChanger::placed(const Eigen::Isometry3d& pose, const StampedFrame& frame)
{
  const auto find_object = [this](const std::string& id) -> std::optional<ObjectFrame>
  {
    if (const AttachedObject* attached = attached_.find(id))
      return ObjectFrame{&attached->object.pose, &attached->object.subframes, attached->link};
    if (const WorldObject* object = objects_.find(id))
      return ObjectFrame{&object->pose, &object->subframes};
    return std::nullopt;
  };
  const PlanningScene& scene = result_.scene;
  const auto known = findFrame({*scene.robot, scene.fixed_frames, find_object}, frame.name, knownState());
  const Eigen::Isometry3d found = known ? *known : lookup_(frame);
  requirePose(found, "frame '" + frame.name + "'");
  requirePose(found * pose, "a place in frame '" + frame.name + "'");
  return found * pose;
}

bool SceneChanger::isPlanningFrame(const std::string& name) const
{
  const std::string& planning_frame = result_.scene.robot->planningFrame();
  return name.empty() || name == planning_frame || name == "/" + planning_frame;
}

void appendShapes(const ObjectChange& change, WorldObject& object)
{
  const std::optional<SolidRule> rule = solidRuleOf(object.shapes);
  object.shapes.insert(object.shapes.end(), change.shapes.begin(), change.shapes.end());
  if (rule)
    setSolidRule(object.shapes, *rule);
  orderShapes(object.shapes);
  for (const auto& [name, pose] : change.subframes)
    object.subframes[name] = pose;
  if (!change.type.isEmpty())
    object.type = change.type;
}
}  // namespace gpu_planning_scene::core
