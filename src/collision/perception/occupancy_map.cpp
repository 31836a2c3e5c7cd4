#include "gpu_planning_scene/occupancy_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/text/number_text.h"
#include "collision/perception/body_filter.h"
#include "collision/perception/measurement.h"
#include "collision/perception/voxel_grid.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"
#include "model/rigid_pose.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// After so many measurements that see through it, a voxel is removed whatever its history.
constexpr std::uint8_t kMaxEvidence = 3;

// Seconds: a measurement may come so much later than those of other sensors. A larger difference is a clock that was
// set back.
constexpr double kMaxDelay = 2.0;

bool isBefore(double time, double other)
{
  return time < other && other - time <= kMaxDelay;
}

struct Voxel
{
  std::uint64_t key;
  double seen;            // seconds: the time of the last hit
  std::uint8_t evidence;  // 1 to kMaxEvidence
};

void requireMetres(bool fits, double value, const char* what)
{
  if (!fits || !std::isfinite(value))
    throw Error(std::string("sensors: ") + what + " is " + numberText(value) + "; it must be a finite number" +
                (value <= 0.0 ? " above 0" : ""));
}
}  // namespace

struct OccupancyMap::Impl
{
  explicit Impl(const OccupancyMapOptions& given) : options(given), grid(given.resolution) {}

  void add(const Measurement& measurement, const SensorView& view, const PlanningScene& scene, const double* state,
           const std::set<std::string>& left_out);
  std::vector<Voxel> hitVoxels(const Measurement& measurement, const Isometry3d& sensor, double time) const;
  std::vector<Voxel> merged(const std::vector<Voxel>& hits, const std::vector<PlacedView>& views,
                            const Isometry3d& sensor, double time) const;
  std::vector<Vector3d> centersOf(const std::vector<Voxel>& some) const;

  const OccupancyMapOptions options;
  const VoxelGrid grid;
  BodyFilter bodies;
  std::vector<Voxel> voxels;       // in ascending order of their keys
  std::set<std::string> attached;  // objects that were attached at the last measurement
};

std::vector<Vector3d> OccupancyMap::Impl::centersOf(const std::vector<Voxel>& some) const
{
  std::vector<Vector3d> centers;
  centers.reserve(some.size());
  for (const Voxel& voxel : some)
    centers.push_back(grid.centerOf(voxel.key));
  return centers;
}

/// The voxels that contain a point of the region and whose centers are in a view, in ascending order of their keys,
/// each once. A voxel at the border of an image, with its center outside, could not be removed again.
std::vector<Voxel> OccupancyMap::Impl::hitVoxels(const Measurement& measurement, const Isometry3d& sensor,
                                                 double time) const
{
  VoxelKeys keys;
  for (const Vector3d& point : measurement.points)
  {
    const Vector3d placed = sensor * point;
    if (options.region.contains(placed))
      keys.add(grid.keyOf(placed));
  }
  std::vector<Voxel> hits;
  const Isometry3d to_sensor = sensor.inverse();
  for (const std::uint64_t key : keys.take())
  {
    const Vector3d center = to_sensor * grid.centerOf(key);
    if (std::any_of(measurement.views.begin(), measurement.views.end(),
                    [&](const PlacedView& placed) { return placed.depths.shows(placed.from_sensor * center); }))
      hits.push_back({key, time, 1});
  }
  return hits;
}

/// The voxels after a measurement.
std::vector<Voxel> OccupancyMap::Impl::merged(const std::vector<Voxel>& hits, const std::vector<PlacedView>& views,
                                              const Isometry3d& sensor, double time) const
{
  const Isometry3d to_sensor = sensor.inverse();
  const double radius = 0.5 * std::sqrt(3.0) * grid.size();  // of the ball around a voxel
  const auto is_seen_through = [&](const Voxel& voxel)
  {
    const Vector3d center = to_sensor * grid.centerOf(voxel.key);
    return std::any_of(views.begin(), views.end(),
                       [&](const PlacedView& view)
                       { return view.depths.seesBehind(view.from_sensor * center, radius); });
  };
  std::vector<Voxel> all;
  all.reserve(voxels.size() + hits.size());
  auto hit = hits.begin();
  for (Voxel voxel : voxels)
  {
    for (; hit != hits.end() && hit->key < voxel.key; ++hit)
      all.push_back(*hit);
    if (hit != hits.end() && hit->key == voxel.key)
    {
      ++hit;
      voxel.seen = isBefore(time, voxel.seen) ? voxel.seen : time;
      voxel.evidence = std::min<std::uint8_t>(voxel.evidence + 1, kMaxEvidence);
    }
    else if (options.decay > 0.0 && time - voxel.seen > options.decay)
      continue;
    else if (!isBefore(time, voxel.seen) && is_seen_through(voxel))
      --voxel.evidence;
    if (voxel.evidence > 0)
      all.push_back(voxel);
  }
  all.insert(all.end(), hit, hits.end());
  return all;
}

void OccupancyMap::Impl::add(const Measurement& measurement, const SensorView& view, const PlanningScene& scene,
                             const double* state, const std::set<std::string>& left_out)
{
  std::set<std::string> attached_now;
  std::set<std::string> objects = left_out;
  for (const AttachedObject& carried : scene.attached)
  {
    attached_now.insert(carried.object.id);
    if (attached.count(carried.object.id) == 0)
      objects.insert(carried.object.id);
  }
  const Isometry3d sensor = nearestRigid(view.sensor, "the sensor's pose");
  const auto near_bodies = [&](const std::vector<Voxel>& some)
  { return bodies.near(grid, centersOf(some), scene, state, view.padding, objects); };
  std::vector<Voxel> hits = hitVoxels(measurement, sensor, view.time);
  removeFlagged(hits, near_bodies(hits));
  std::vector<Voxel> all = merged(hits, measurement.views, sensor, view.time);
  if (!objects.empty())
    removeFlagged(all, near_bodies(all), kNearObject);
  if (all.size() > options.max_voxels)
    throw Error("the sensors have found " + std::to_string(all.size()) + " occupied voxels, but at most " +
                std::to_string(options.max_voxels) + " are allowed; use larger voxels, a shorter range or a region");
  voxels = std::move(all);
  attached = std::move(attached_now);
}

OccupancyMap::OccupancyMap(const OccupancyMapOptions& options)
{
  requireMetres(options.resolution > 0.0, options.resolution, "the resolution");
  requireMetres(options.decay >= 0.0, options.decay, "the decay");
  if (options.region.isEmpty())
    throw Error("sensors: the region is empty; its first corner must have the smaller coordinates");
  impl_ = std::make_unique<Impl>(options);
}

OccupancyMap::~OccupancyMap() = default;

void OccupancyMap::add(const DepthImage& image, const SensorView& view, const PlanningScene& scene, const double* state,
                       const std::set<std::string>& left_out)
{
  validateStates(*scene.robot, state, 1);
  impl_->add(measurementOf(image, view), view, scene, state, left_out);
}

void OccupancyMap::add(const std::vector<Vector3f>& points, const SensorView& view, const PlanningScene& scene,
                       const double* state, const std::set<std::string>& left_out)
{
  validateStates(*scene.robot, state, 1);
  impl_->add(measurementOf(points, view), view, scene, state, left_out);
}

void OccupancyMap::removeNear(const std::set<std::string>& objects, double padding, const PlanningScene& scene,
                              const double* state)
{
  validateStates(*scene.robot, state, 1);
  const std::vector<Vector3d> centers = impl_->centersOf(impl_->voxels);
  removeFlagged(impl_->voxels, impl_->bodies.near(impl_->grid, centers, scene, state, padding, objects), kNearObject);
}

std::vector<PlacedShape> OccupancyMap::cubes(const PlanningScene& scene, const double* state)
{
  validateStates(*scene.robot, state, 1);
  std::vector<Vector3d> centers = impl_->centersOf(impl_->voxels);
  removeFlagged(centers, impl_->bodies.near(impl_->grid, centers, scene, state, 0.0, {}), kNearRobot);
  return impl_->grid.cubesAt(centers);
}

std::size_t OccupancyMap::size() const
{
  return impl_->voxels.size();
}

void OccupancyMap::clear()
{
  impl_->voxels.clear();
}
}  // namespace gpu_planning_scene::core
