#include "node/sensors/sensed_map.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <ros/console.h>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "node/endpoints/respond.h"
#include "node/sensors/sensed_object.h"

namespace gpu_planning_scene::core
{
namespace
{
std::set<std::string> attachedIds(const PlanningScene& scene)
{
  std::set<std::string> ids;
  for (const AttachedObject& attached : scene.attached)
    ids.insert(attached.object.id);
  return ids;
}

/// The elements of `a` that are not in `b`.
std::set<std::string> difference(const std::set<std::string>& a, const std::set<std::string>& b)
{
  std::set<std::string> result;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::inserter(result, result.end()));
  return result;
}
}  // namespace

SensedMap::SensedMap(SceneStore& store, const OccupancyMapOptions& options, double padding)
  : store_(store), padding_(padding), map_(options)
{
  if (store_.snapshot().scene->findObject(kOctomapId))
    throw Error("parameter ~scene: the scene has an octomap, which the sensors of ~sensors would replace; remove it");
  store_.reserveOctomap();
}

void SensedMap::add(const Measurement& measurement, const SensorView& view, const std::vector<double>& state)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const Snapshot now = store_.snapshot();
  followObjects(*now.scene, now.state);
  const std::size_t without_room = std::visit(
      [&](const auto& measured) { return map_.add(measured, view, *now.scene, state.data(), excluded_); }, measurement);
  publish();
  if (without_room > 0)
    throw Error(std::to_string(without_room) +
                " voxels are not in the scene, the farthest from the robot, because ~limits/voxels is reached; use "
                "larger voxels (~octomap_resolution), a shorter range or a region");
}

std::uint64_t SensedMap::exclude(const std::set<std::string>& objects)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const Snapshot now = store_.snapshot();
  for (const std::string& id : objects)
    if (!now.scene->findObject(id) && !now.scene->findAttached(id))
      throw Error("the scene has no object '" + id + "'; add it first");
  map_.removeNear(difference(objects, attachedIds(*now.scene)), padding_, *now.scene, now.state.data());
  const std::uint64_t revision = publish();
  excluded_ = objects;
  return revision;
}

std::uint64_t SensedMap::clear()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  map_.clear();
  return publish();
}

void SensedMap::republish()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!hides_voxels_)
    return;
  if (const std::string error = errorOf([this] { publish(); }); !error.empty())
    ROS_ERROR_STREAM_THROTTLE(10.0, "the octomap of the sensors stays as it is: " << error);
}

/// Objects that were attached since the last measurement lose their voxels, and ids of removed objects are not excluded
/// any more. mutex_ is held.
void SensedMap::followObjects(const PlanningScene& scene, const std::vector<double>& state)
{
  const std::set<std::string> attached = attachedIds(scene);
  if (const std::set<std::string> added = difference(attached, attached_); !added.empty())
    map_.removeNear(added, padding_, scene, state.data());
  attached_ = attached;
  for (const std::string& id : std::set<std::string>(excluded_))
    if (!scene.findObject(id) && !scene.findAttached(id))
      excluded_.erase(id);
}

/// Puts the voxels into the scene. Returns the scene's revision. mutex_ is held.
std::uint64_t SensedMap::publish()
{
  hides_voxels_ = true;  // until the scene has the voxels: an error must not end the tries
  const Snapshot now = store_.snapshot();
  std::vector<PlacedShape> cubes = map_.cubes(*now.scene, now.state.data());
  const bool hides_voxels = cubes.size() < map_.size();
  replaceObject(store_, kOctomapId, std::move(cubes));
  hides_voxels_ = hides_voxels;
  return store_.snapshot().scene->revision;
}
}  // namespace gpu_planning_scene::core
