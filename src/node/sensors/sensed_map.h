#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "gpu_planning_scene/occupancy_map.h"
#include "service/scene_store.h"

namespace gpu_planning_scene::core
{
/// The occupancy map of the sensors, and its cubes in the scene: the object kOctomapId. Thread-safe.
class SensedMap
{
 public:
  using Measurement = std::variant<DepthImage, std::vector<Eigen::Vector3f>>;

  /// Reserves the octomap (SceneStore::reserveOctomap). `padding`: metres, the largest padding of the sensors. `store`
  /// must outlive this object. Throws Error if the scene already has an octomap, or if an option is not valid.
  SensedMap(SceneStore& store, const OccupancyMapOptions& options, double padding);
  ~SensedMap();
  SensedMap(const SensedMap&) = delete;
  SensedMap& operator=(const SensedMap&) = delete;

  /// Puts a measurement into the map, and the map into the scene. `state`: one value per variable, of the time of the
  /// measurement. `lose`: gets the number of voxels that found no room (see OccupancyMap::add), if there are any,
  /// before the scene lacks them. Throws the errors of OccupancyMap::add and SceneStore::sense.
  void add(const Measurement& measurement, const SensorView& view, const std::vector<double>& state,
           const std::function<void(std::size_t voxels)>& lose = {});

  /// From now on, these objects are left out of the map, and no others. Their voxels are removed. Returns the revision
  /// of the scene without them. Throws Error if the scene has no such object.
  std::uint64_t exclude(const std::set<std::string>& objects);

  /// Forgets all voxels. Calls `cleared` before the scene lacks them. Returns the revision of the scene without them.
  std::uint64_t clear(const std::function<void()>& cleared = {});

  /// Brings the scene up to date without a measurement: voxels that the robot has left are whole again, and voxels of
  /// objects that were attached are removed. An error is logged, not thrown.
  void republish();

 private:
  /// Objects that were attached, in the scene and the state of that moment.
  struct Attached
  {
    std::set<std::string> ids;
    std::shared_ptr<const PlanningScene> scene;
    std::vector<double> state;
  };

  void noteAttached(const PlanningScene& before, const std::shared_ptr<const PlanningScene>& after);
  bool followObjects();
  std::optional<Attached> takeAttached();
  std::uint64_t publish();

  SceneStore& store_;
  const double padding_;
  std::mutex mutex_;  // guards the members below
  OccupancyMap map_;
  std::set<std::string> excluded_;
  bool hides_voxels_ = false;  // parts of voxels that the robot touches are not in the scene

  std::mutex attached_mutex_;      // guards the next member
  std::deque<Attached> attached_;  // whose voxels are still in the map
};
}  // namespace gpu_planning_scene::core
