#include "node/sensors/sensed_map.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <ros/console.h>

#include "base/text/name_list.h"
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
  store_.setListener(this, [this](const auto& before, const auto& after) { noteAttached(*before, after); });
}

SensedMap::~SensedMap()
{
  store_.setListener(this, {});
}

void SensedMap::add(const Measurement& measurement, const SensorView& view, const std::vector<double>& state,
                    const std::function<void(std::size_t voxels)>& lose)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  followObjects();
  const Snapshot now = store_.snapshot();
  const std::size_t without_room = std::visit(
      [&](const auto& measured) { return map_.add(measured, view, *now.scene, state.data(), excluded_); }, measurement);
  if (without_room > 0 && lose)
    lose(without_room);
  publish();
}

std::uint64_t SensedMap::exclude(const std::set<std::string>& objects)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const Snapshot now = store_.snapshot();
  for (const std::string& id : objects)
    if (!now.scene->findObject(id) && !now.scene->findAttached(id))
      throw Error("the scene has no object '" + id + "'; add it first");
  map_.removeNear(difference(objects, attachedIds(*now.scene)), padding_, *now.scene, now.state.data());
  excluded_ = objects;
  return publish();
}

std::uint64_t SensedMap::clear(const std::function<void()>& cleared)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  map_.clear();
  if (cleared)
    cleared();
  return publish();
}

void SensedMap::republish()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!followObjects() && !hides_voxels_)
    return;
  if (const std::string error = errorOf([this] { publish(); }); !error.empty())
    ROS_ERROR_STREAM_THROTTLE(10.0, "the octomap of the sensors stays as it is: " << error);
}

/// Called during a change of the scene, so it only notes what followObjects() does: an object that is attached is
/// carried away from its voxels.
void SensedMap::noteAttached(const PlanningScene& before, const std::shared_ptr<const PlanningScene>& after)
{
  std::set<std::string> ids = difference(attachedIds(*after), attachedIds(before));
  if (ids.empty())
    return;
  Snapshot now = store_.snapshot();
  if (!now.allKnown())
  {
    ROS_WARN_STREAM("the robot's state is not known, so the octomap keeps the voxels of attached objects: "
                    << nameList({ids.begin(), ids.end()}));
    return;
  }
  const std::lock_guard<std::mutex> lock(attached_mutex_);
  attached_.push_back({std::move(ids), after, std::move(now.state)});
}

/// Objects that were attached since the last call lose the voxels of the place where they were then, and ids of removed
/// objects are not excluded any more. Returns whether an object was attached. mutex_ is held.
bool SensedMap::followObjects()
{
  bool has_followed = false;
  for (std::optional<Attached> next = takeAttached(); next; next = takeAttached())
  {
    const std::string error = errorOf([&] { map_.removeNear(next->ids, padding_, *next->scene, next->state.data()); });
    if (!error.empty())
      ROS_ERROR_STREAM("the octomap keeps the voxels of attached objects: " << error);
    has_followed = true;
  }
  const std::shared_ptr<const PlanningScene> scene = store_.snapshot().scene;
  for (const std::string& id : std::set<std::string>(excluded_))
    if (!scene->findObject(id) && !scene->findAttached(id))
      excluded_.erase(id);
  return has_followed;
}

std::optional<SensedMap::Attached> SensedMap::takeAttached()
{
  const std::lock_guard<std::mutex> lock(attached_mutex_);
  if (attached_.empty())
    return std::nullopt;
  std::optional<Attached> first = std::move(attached_.front());
  attached_.pop_front();
  return first;
}

/// Puts the voxels into the scene. Returns the scene's revision. mutex_ is held.
std::uint64_t SensedMap::publish()
{
  hides_voxels_ = true;  // until the scene has the voxels: an error must not end the tries
  const Snapshot now = store_.snapshot();
  VoxelCubes visible = map_.cubes(*now.scene, now.allKnown() ? now.state.data() : nullptr);
  if (!visible.has_all_parts)
    ROS_WARN_STREAM_THROTTLE(10.0,
                             "the robot touches voxels of the octomap, and the scene has no room for their parts that "
                             "it does not touch (~limits/voxels), or a voxel is too far away for them; it collides");
  replaceObject(store_, kOctomapId, std::move(visible.cubes));
  hides_voxels_ = !visible.are_whole || !now.allKnown();
  return store_.snapshot().scene->revision;
}
}  // namespace gpu_planning_scene::core
