#include "scene/validate_scene.h"

#include <algorithm>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "gpu_planning_scene/error.h"
#include "model/rigid_pose.h"
#include "model/scaled_shapes.h"

// Everything is checked in each scene, except meshes that were found valid before. They are known by their addresses; a
// weak pointer shows whether an address still belongs to the same mesh. Own method.
namespace gpu_planning_scene::core
{
namespace
{
/// isRigid() comes first, because rigid() also corrects the rotation, which takes long.
void validatePose(const Eigen::Isometry3d& pose, const std::string& where)
{
  if (!isRigid(pose))
    nearestRigid(pose, where);
}

void validatePadding(double padding, const std::string& where)
{
  if (!(padding >= 0.0) || padding > kLargestLength)
    throw Error(where + ": the padding is " + std::to_string(padding) + "; it must not be negative, nor above 1000 km");
}

/// Meshes that were found valid, by address.
using Meshes = std::unordered_map<const Mesh*, std::weak_ptr<const Mesh>>;

void validateObject(const WorldObject& object, const Meshes& known, Meshes& valid)
{
  const std::string where = "object '" + object.id + "'";
  validatePose(object.pose, where);
  validatePadding(object.padding, where);
  for (const auto& subframe : object.subframes)
    validatePose(subframe.second, where + ", subframe '" + subframe.first + "'");
  for (const PlacedShape& placed : object.shapes)
  {
    validatePose(placed.pose, where);
    const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape);
    const auto seen = mesh != nullptr ? known.find(mesh->get()) : known.end();
    const bool is_known = seen != known.end() && *mesh && seen->second.lock() == *mesh;
    if (!is_known && (mesh == nullptr || valid.count(mesh->get()) == 0))
      validateShape(placed.shape, where);
    if (mesh != nullptr)
      valid.emplace(mesh->get(), *mesh);
  }
}

void validateAttached(const AttachedObject& attached, const RobotModel& robot, const Meshes& known, Meshes& valid)
{
  validateObject(attached.object, known, valid);
  const std::string where = "attached object '" + attached.object.id + "'";
  const int links = static_cast<int>(robot.links().size());
  const auto require_link = [&](int link, const char* role)
  {
    if (link < 0 || link >= links)
      throw Error(where + ": its " + role + " has index " + std::to_string(link) + ", but the robot has " +
                  std::to_string(links) + " links; name a link of the robot by its index");
  };
  require_link(attached.link, "link");
  for (const int link : attached.touch_links)
    require_link(link, "touch link");
  if (hasHalfSpace(attached.object.shapes))
    throw Error(where + " has a half-space, which cannot be attached; leave it in the world");
  validatePadding(attached.padding, where);
  const std::vector<double>& scale = robot.linkScale();
  const bool is_scaled = !scale.empty() && scale[static_cast<std::size_t>(attached.link)] != 1.0;
  if (is_scaled != (attached.scaled_shapes != nullptr) ||
      (is_scaled &&
       !isScaled(*attached.scaled_shapes, attached.object.shapes, scale[static_cast<std::size_t>(attached.link)])))
    throw Error(where + " does not have its link's scale; call PlanningScene::scaleAttached before adding it");
}
}  // namespace

bool hasHalfSpace(const std::vector<PlacedShape>& shapes)
{
  return std::any_of(
      shapes.begin(), shapes.end(),
      [](const PlacedShape& placed) { return std::holds_alternative<HalfSpace>(placed.shape); });
}

void validateScene(const PlanningScene& scene)
{
  SceneValidator().validate(scene);
}

void SceneValidator::validate(const PlanningScene& scene)
{
  const auto& links = scene.robot->links();
  for (const Link& link : links)
    if (hasHalfSpace(link.shapes))
      throw Error("link '" + link.name + "' has a half-space, which cannot move; put it into the world");
  if (!scene.link_padding.empty() && scene.link_padding.size() != links.size())
    throw Error("link_padding has " + std::to_string(scene.link_padding.size()) + " values for " +
                std::to_string(links.size()) + " links; give one per link, or none");
  for (std::size_t i = 0; i < scene.link_padding.size(); ++i)
    validatePadding(scene.link_padding[i], "link '" + links[i].name + "'");

  Meshes valid;  // meshes of this scene
  std::unordered_set<std::string_view> ids;
  ids.reserve(links.size() + scene.objects.size() + scene.attached.size());
  for (const Link& link : links)
    ids.insert(link.name);
  const auto require_new = [&ids](const std::string& id)
  {
    if (!ids.insert(id).second)
      throw Error("object '" + id + "': a link or another object has the same name; give it another name");
  };
  for (const WorldObject& object : scene.objects)
  {
    require_new(object.id);
    validateObject(object, valid_, valid);
  }
  for (const AttachedObject& attached : scene.attached)
  {
    require_new(attached.object.id);
    validateAttached(attached, *scene.robot, valid_, valid);
  }
  valid_ = std::move(valid);
}
}  // namespace gpu_planning_scene::core
