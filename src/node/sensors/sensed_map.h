#pragma once

#include <cstdint>
#include <mutex>
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

  /// Puts a measurement into the map, and the map into the scene. `state`: one value per variable, of the time of the
  /// measurement. Throws the errors of OccupancyMap::add and SceneStore::sense. Throws
  /// Error if some voxels found no room; the others are in the scene then.
  void add(const Measurement& measurement, const SensorView& view, const std::vector<double>& state);

  /// From now on, these objects are left out of the map, and no others. Their voxels are removed. Returns the revision
  /// of the scene without them. Throws Error if the scene has no such object.
  std::uint64_t exclude(const std::set<std::string>& objects);

  /// Forgets all voxels. Returns the revision of the scene without them.
  std::uint64_t clear();

  /// Puts voxels into the scene that were hidden because the robot touched them, if it has left them. An error is
  /// logged, not thrown.
  void republish();

 private:
  void followObjects(const PlanningScene& scene, const std::vector<double>& state);
  std::uint64_t publish();

  SceneStore& store_;
  const double padding_;
  std::mutex mutex_;  // guards the members below
  OccupancyMap map_;
  std::set<std::string> excluded_;
  std::set<std::string> attached_;  // objects whose voxels were removed when they were attached
  bool hides_voxels_ = false;       // voxels that the robot touches are not in the scene
};
}  // namespace gpu_planning_scene::core
