#include "gpu_planning_scene/occupancy_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

#include "base/text/number_text.h"
#include "collision/perception/body_filter.h"
#include "collision/perception/measurement.h"
#include "collision/perception/voxel_grid.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
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

// Metres between the robot and the parts of a voxel that it touches. A motion out of the voxel could not be proven free
// if they almost touched.
constexpr double kClearance = 1e-3;
constexpr int kSplits = 2;  // of a voxel that the robot touches

// Of the cubes: room for the parts of voxels that the robot touches.
constexpr std::size_t kShareOfParts = 10;

// OctoMap's octrees have 16 levels, so their cubes are within so many of the smallest edges of the origin.
constexpr double kOctreeReach = 32768.0;

struct Voxel
{
  std::uint64_t key;
  double seen;            // seconds: SensorView::time of the last hit
  double received;        // seconds: SensorView::received of the last hit
  std::uint8_t evidence;  // 1 to kMaxEvidence
  bool is_whole;          // a sensor that hit it saw the whole voxel
};

struct Hit
{
  std::uint64_t key;
  bool is_whole;
  bool may_be_robot;  // within the padding of the robot
};

/// Places voxels in the frame of a camera.
struct VoxelProjection
{
  const DepthView& depths;
  Isometry3d to_camera;  // from the planning frame
  Vector3d extent;       // see VoxelInView
  double inner_radius;

  VoxelInView view(const Vector3d& centre) const { return {to_camera * centre, extent, inner_radius}; }
};

/// The largest required distance between a voxel and any body of the robot, by the largest paddings.
double requiredDistance(const PlanningScene& scene)
{
  double of_links = 0.0;
  for (const double padding : scene.link_padding)
    of_links = std::max(of_links, padding);
  double of_objects = 0.0;
  for (const AttachedObject& attached : scene.attached)
    of_objects = std::max(of_objects, attached.padding);
  const WorldObject* const octomap = scene.findObject(kOctomapId);
  return of_links + of_objects + (octomap != nullptr ? octomap->padding : 0.0);
}

bool hasSmallerKey(const Voxel& a, const Voxel& b)
{
  return a.key < b.key;
}
}  // namespace

struct OccupancyMap::Impl
{
  explicit Impl(const OccupancyMapOptions& given) : options(given), grid(given.resolution) {}

  std::size_t add(const Measurement& measurement, const SensorView& view, const PlanningScene& scene,
                  const double* state, const std::set<std::string>& left_out);
  std::vector<VoxelProjection> projectionsOf(const Measurement& measurement, const Isometry3d& sensor) const;
  std::vector<Hit> hitVoxels(const Measurement& measurement, const Isometry3d& sensor) const;
  template <class Keyed>
  std::vector<Vector3d> centresOf(const std::vector<Keyed>& some) const;
  std::vector<Voxel> takeKnown(std::vector<Hit>& hits, const Measurement& measurement, const Isometry3d& sensor,
                               const SensorView& view) const;
  void keepNearest(const PlanningScene& scene, const double* state, std::vector<Voxel>& some) const;
  VoxelCubes cubes(const PlanningScene& scene, const double* state);
  std::vector<Vector3d> updateSplit(const PlanningScene& scene, const double* state);
  std::size_t room() const { return options.max_voxels - options.max_voxels / kShareOfParts; }
  double reach() const;

  const OccupancyMapOptions options;
  const VoxelGrid grid;
  BodyFilter bodies;
  std::vector<Voxel> voxels;         // in ascending order of their keys
  std::vector<std::uint64_t> split;  // keys of the voxels that cubes() splits, in ascending order
};

template <class Keyed>
std::vector<Vector3d> OccupancyMap::Impl::centresOf(const std::vector<Keyed>& some) const
{
  std::vector<Vector3d> centres;
  centres.reserve(some.size());
  for (const Keyed& voxel : some)
    centres.push_back(grid.centreOf(voxel.key));
  return centres;
}

std::vector<VoxelProjection> OccupancyMap::Impl::projectionsOf(const Measurement& measurement,
                                                               const Isometry3d& sensor) const
{
  const double half = 0.5 * grid.size();
  std::vector<VoxelProjection> projections;
  for (const PlacedView& placed : measurement.views)
  {
    const Isometry3d to_camera = Isometry3d(placed.from_sensor) * sensor.inverse();
    projections.push_back({placed.depths, to_camera, to_camera.linear().cwiseAbs() * Vector3d::Constant(half), half});
  }
  return projections;
}

/// The voxels that contain a point of the region and whose centres are in a view, in ascending order of their keys,
/// each once. A voxel at the border of an image, with its centre outside, could not be removed again. A cloud has no
/// border.
std::vector<Hit> OccupancyMap::Impl::hitVoxels(const Measurement& measurement, const Isometry3d& sensor) const
{
  VoxelKeys keys;
  for (const Vector3d& point : measurement.points)
  {
    const Vector3d placed = sensor * point;
    if (options.region.contains(placed))
      keys.add(grid.keyOf(placed));
  }
  std::vector<Hit> hits;
  const std::vector<VoxelProjection> projections = projectionsOf(measurement, sensor);
  for (const std::uint64_t key : keys.take())
  {
    const Vector3d centre = grid.centreOf(key);
    const auto is_shown = [&](const VoxelProjection& to) { return to.depths.shows(to.view(centre).centre); };
    const auto is_whole = [&](const VoxelProjection& to) { return to.depths.showsAll(to.view(centre)); };
    if (measurement.looks_everywhere)
      hits.push_back({key, true, false});
    else if (std::any_of(projections.begin(), projections.end(), is_shown))
      hits.push_back({key, std::any_of(projections.begin(), projections.end(), is_whole), false});
  }
  return hits;
}

/// The known voxels after a measurement. Takes their hits out of `hits`. A point near the robot counts for a voxel that
/// is known: a robot that stands beside an obstacle does not let it decay. A voxel at the border of an image is seen
/// through in its visible half; this removes only a voxel that no sensor has ever seen whole.
std::vector<Voxel> OccupancyMap::Impl::takeKnown(std::vector<Hit>& hits, const Measurement& measurement,
                                                 const Isometry3d& sensor, const SensorView& view) const
{
  const std::vector<VoxelProjection> projections = projectionsOf(measurement, sensor);
  const auto is_seen_through = [&](const Voxel& voxel)
  {
    const Vector3d centre = grid.centreOf(voxel.key);
    return std::any_of(projections.begin(), projections.end(),
                       [&](const VoxelProjection& to)
                       {
                         const VoxelInView seen = to.view(centre);
                         return to.depths.seesBehind(seen) &&
                                (!voxel.is_whole || measurement.looks_everywhere || to.depths.showsAll(seen));
                       });
  };
  std::vector<Voxel> known;
  known.reserve(voxels.size());
  std::vector<Hit> others;
  auto hit = hits.begin();
  for (Voxel voxel : voxels)
  {
    for (; hit != hits.end() && hit->key < voxel.key; ++hit)
      others.push_back(*hit);
    if (hit != hits.end() && hit->key == voxel.key)
    {
      voxel.seen = isBefore(view.time, voxel.seen) ? voxel.seen : view.time;
      voxel.received = view.received;
      voxel.evidence = std::min<std::uint8_t>(voxel.evidence + 1, kMaxEvidence);
      voxel.is_whole = voxel.is_whole || hit->is_whole;
      ++hit;
    }
    else if (options.decay > 0.0 && view.received - voxel.received > options.decay)
      continue;
    else if (!isBefore(view.time, voxel.seen) && is_seen_through(voxel))
      --voxel.evidence;
    if (voxel.evidence > 0)
      known.push_back(voxel);
  }
  others.insert(others.end(), hit, hits.end());
  hits = std::move(others);
  return known;
}

std::size_t OccupancyMap::Impl::add(const Measurement& measurement, const SensorView& view, const PlanningScene& scene,
                                    const double* state, const std::set<std::string>& left_out)
{
  // An attached object counts as the robot: it moves, and voxels that it comes near must stay.
  std::set<std::string> objects = left_out;
  for (const AttachedObject& carried : scene.attached)
    objects.erase(carried.object.id);
  const Isometry3d sensor = nearestRigid(view.sensor, "the sensor's pose");
  const auto near_bodies = [&](const auto& some)
  { return bodies.near(grid, centresOf(some), scene, state, view.padding, objects); };

  std::vector<Hit> hits = hitVoxels(measurement, sensor);
  std::vector<std::uint8_t> flags = near_bodies(hits);
  for (std::size_t i = 0; i < hits.size(); ++i)
    hits[i].may_be_robot = (flags[i] & kNearRobot) != 0;
  removeFlagged(hits, flags, kNearObject);
  std::vector<Voxel> known = takeKnown(hits, measurement, sensor, view);
  if (!objects.empty())
    removeFlagged(known, near_bodies(known), kNearObject);
  hits.erase(std::remove_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.may_be_robot; }), hits.end());

  const auto middle = static_cast<std::ptrdiff_t>(known.size());
  for (const Hit& hit : hits)
    known.push_back({hit.key, view.time, view.received, 1, hit.is_whole});
  std::inplace_merge(known.begin(), known.begin() + middle, known.end(), hasSmallerKey);
  const std::size_t without_room = known.size() - std::min(known.size(), room());
  if (without_room > 0)
    keepNearest(scene, state, known);
  voxels = std::move(known);
  return without_room;
}

/// Keeps as many voxels as the map may have: those nearest to the origins of the robot's links, in the order of their
/// keys. So two sensors do not take each other's voxels away in turn.
void OccupancyMap::Impl::keepNearest(const PlanningScene& scene, const double* state, std::vector<Voxel>& some) const
{
  std::vector<Isometry3d> links(scene.robot->links().size());
  scene.robot->linkPoses(state, links.data());
  std::vector<std::pair<double, Voxel>> by_distance;
  by_distance.reserve(some.size());
  for (const Voxel& voxel : some)
  {
    const Vector3d centre = grid.centreOf(voxel.key);
    double least = std::numeric_limits<double>::infinity();
    for (const Isometry3d& link : links)
      least = std::min(least, (link.translation() - centre).squaredNorm());
    by_distance.emplace_back(least, voxel);
  }
  const auto last = by_distance.begin() + static_cast<std::ptrdiff_t>(room());
  std::nth_element(by_distance.begin(), last, by_distance.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  some.clear();
  for (auto kept = by_distance.begin(); kept != last; ++kept)
    some.push_back(kept->second);
  std::sort(some.begin(), some.end(), hasSmallerKey);
}

/// Updates `split`. A voxel is split from when the robot touches it, or a voxel beside it, until the robot is farther
/// from it than its paddings: until then the robot could not leave a whole voxel. Returns the centres of the other
/// voxels.
std::vector<Vector3d> OccupancyMap::Impl::updateSplit(const PlanningScene& scene, const double* state)
{
  std::vector<Vector3d> centres = centresOf(voxels);
  const std::vector<std::uint8_t> touches = bodies.near(grid, centres, scene, state, 0.0, {});
  std::set<std::uint64_t> candidates(split.begin(), split.end());
  for (std::size_t i = 0; i < voxels.size(); ++i)
    if ((touches[i] & kNearRobot) != 0)
      for (const std::uint64_t key : VoxelGrid::around(voxels[i].key))
        candidates.insert(key);
  split.clear();
  if (candidates.empty())
    return centres;
  std::vector<std::size_t> numbers;
  std::vector<Vector3d> some;
  for (std::size_t i = 0; i < voxels.size(); ++i)
    if (candidates.count(voxels[i].key) != 0)
    {
      numbers.push_back(i);
      some.push_back(centres[i]);
    }
  const std::vector<std::uint8_t> near =
      bodies.near(grid, some, scene, state, requiredDistance(scene) + kClearance, {});
  std::vector<std::uint8_t> is_split(voxels.size(), 0);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if ((near[i] & kNearRobot) != 0)
    {
      is_split[numbers[i]] = kNearRobot;
      split.push_back(voxels[numbers[i]].key);
    }
  removeFlagged(centres, is_split);
  return centres;
}

/// Metres: the largest coordinate of the voxels.
double OccupancyMap::Impl::reach() const
{
  double reach = 0.0;
  for (const Voxel& voxel : voxels)
    reach = std::max(reach, grid.centreOf(voxel.key).cwiseAbs().maxCoeff() + 0.5 * grid.size());
  return reach;
}

VoxelCubes OccupancyMap::Impl::cubes(const PlanningScene& scene, const double* state)
{
  VoxelCubes visible;
  visible.cubes = grid.cubesAt(updateSplit(scene, state));
  visible.are_whole = split.empty();
  std::vector<Vector3d> near;  // cubes of `parts` that are too near to the robot
  for (const std::uint64_t key : split)
    near.push_back(grid.centreOf(key));
  VoxelGrid parts = grid;
  const double farthest = reach();
  for (int level = 0; level < kSplits; ++level)
  {
    const std::size_t count = visible.cubes.size() + 8 * near.size();
    if (count > options.max_voxels || farthest > kOctreeReach * 0.5 * parts.size())
    {
      // The scene takes no smaller parts. The robot collides with these ones, which is better than none.
      for (PlacedShape& cube : parts.cubesAt(near))
        visible.cubes.push_back(std::move(cube));
      visible.has_all_parts = near.empty();
      break;
    }
    std::vector<Vector3d> centres = parts.eighthsOf(near);
    parts = VoxelGrid(0.5 * parts.size());
    std::vector<std::uint8_t> flags =
        bodies.near(parts, centres, scene, state, requiredDistance(scene) + kClearance, {});
    near = centres;
    removeFlagged(centres, flags, kNearRobot);
    for (PlacedShape& cube : parts.cubesAt(centres))
      visible.cubes.push_back(std::move(cube));
    for (std::uint8_t& flag : flags)  // now the others are removed
      flag ^= kNearRobot;
    removeFlagged(near, flags, kNearRobot);
  }
  return visible;
}

OccupancyMap::OccupancyMap(const OccupancyMapOptions& options)
{
  if (!(options.resolution > 0.0) || !std::isfinite(options.resolution))
    throw Error("sensors: the resolution is " + numberText(options.resolution) + " m; it must be finite and above 0");
  if (!(options.decay >= 0.0) || !std::isfinite(options.decay))
    throw Error("sensors: the decay is " + numberText(options.decay) + " s; it must be finite and not negative");
  if (options.region.isEmpty())
    throw Error("sensors: the region is empty; its first corner must have the smaller coordinates");
  impl_ = std::make_unique<Impl>(options);
}

OccupancyMap::~OccupancyMap() = default;

std::size_t OccupancyMap::add(const DepthImage& image, const SensorView& view, const PlanningScene& scene,
                              const double* state, const std::set<std::string>& left_out)
{
  validateStates(*scene.robot, state, 1);
  return impl_->add(measurementOf(image, view), view, scene, state, left_out);
}

std::size_t OccupancyMap::add(const std::vector<Vector3f>& points, const SensorView& view, const PlanningScene& scene,
                              const double* state, const std::set<std::string>& left_out)
{
  validateStates(*scene.robot, state, 1);
  return impl_->add(measurementOf(points, view), view, scene, state, left_out);
}

void OccupancyMap::removeNear(const std::set<std::string>& objects, double padding, const PlanningScene& scene,
                              const double* state)
{
  validateStates(*scene.robot, state, 1);
  const std::vector<Vector3d> centres = impl_->centresOf(impl_->voxels);
  removeFlagged(impl_->voxels, impl_->bodies.near(impl_->grid, centres, scene, state, padding, objects), kNearObject);
}

VoxelCubes OccupancyMap::cubes(const PlanningScene& scene, const double* state)
{
  if (state == nullptr)
    return {impl_->grid.cubesAt(impl_->centresOf(impl_->voxels))};
  validateStates(*scene.robot, state, 1);
  return impl_->cubes(scene, state);
}

std::size_t OccupancyMap::size() const
{
  return impl_->voxels.size();
}

void OccupancyMap::clear()
{
  impl_->voxels.clear();
  impl_->split.clear();
}
}  // namespace gpu_planning_scene::core
