#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A pinhole camera without distortion, as in sensor_msgs/CameraInfo. All lengths are pixels. The centre of the first
/// pixel is at (0, 0).
struct PinholeCamera
{
  int width = 0;
  int height = 0;
  double fx = 0.0;  ///< focal lengths
  double fy = 0.0;
  double cx = 0.0;  ///< the principal point
  double cy = 0.0;

  /// The place of a pixel in an array of pixels, row by row.
  std::size_t pixel(int x, int y) const
  {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// A depth image, as REP 118 defines it: metres along the optical axis, row by row. NaN or 0: not measured. Infinity:
/// the ray meets nothing within the sensor's range. Negative (also infinite): something is too close to be measured.
/// Frame: x to the right, y down, z forward (REP 103).
struct DepthImage
{
  PinholeCamera camera;
  std::vector<float> depths;
};

/// The circumstances of a measurement.
struct SensorView
{
  Eigen::Isometry3d sensor = Eigen::Isometry3d::Identity();  ///< pose of the sensor's frame in the planning frame
  double time = 0.0;      ///< seconds: of the measurement, on the clock of the sensors
  double received = 0.0;  ///< seconds: of the arrival, on one clock that is never set back
  /// Metres: along the optical axis for images, from the sensor for clouds. Nearer points are not used.
  /// Points behind the maximum are not used, but their rays show that there is nothing up to the maximum.
  double min_range = 0.0;
  double max_range = 10.0;
  /// Metres: if a voxel is at most this far from the robot or a left-out object, its points are not used, because they
  /// may be points of the surface of this body.
  double padding = 0.03;
};

struct OccupancyMapOptions
{
  double resolution = 0.05;  ///< metres: edge length of a voxel
  /// In the planning frame. Points outside are not used. The default is everything.
  Eigen::AlignedBox3d region = {Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity()),
                                Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())};
  /// Seconds (SensorView::received): a voxel that no point has hit for so long is removed, also where no sensor looks.
  /// 0: never.
  double decay = 0.0;
  /// The largest number of cubes, see OccupancyMap::cubes. The map keeps nine tenths of so many voxels.
  std::size_t max_voxels = 200'000;
};

/// The voxels as shapes of a scene: see OccupancyMap::cubes().
struct VoxelCubes
{
  std::vector<PlacedShape> cubes;
  bool are_whole = true;      ///< false: the robot is in or beside a voxel, so a part of it is missing
  bool has_all_parts = true;  ///< false: the robot touches parts that could not be made smaller
};

/// The voxels that depth cameras and laser scanners have found occupied. Free space is not stored, because the scene
/// does not need it.
///
/// A measured point occupies its voxel at once. These points are not used: points outside the range or the region,
/// points near the robot (SensorView::padding), and points of an image in a voxel whose centre is outside the image.
///
/// A measurement sees through a voxel if it has rays to the space behind the voxel, and no ray that ends at or before
/// the voxel (see DepthView). Each voxel has a number from 1 to 3. A measurement with a point in the voxel
/// adds 1, and a measurement that sees through it subtracts 1. At 0, the voxel is removed, so three measurements that
/// see through it are enough. A voxel that no sensor sees stays, for example one that the robot hides. A measurement
/// may come up to two seconds late. It does not lower a voxel in which a newer measurement has a point.
///
/// A ray that is not measured may have met a body that the camera cannot measure. So the measurement does not see
/// through a voxel near such a ray. A single pixel among measured ones does not count.
///
/// The robot, its attached objects, and objects that the caller names are left out by their exact geometry: see
/// SensorView::padding and cubes(). Voxels that were occupied before the robot came near them stay.
///
/// Counting hits and misses with a bound follows A. Hornung, K. M. Wurm, M. Bennewitz, C. Stachniss, W. Burgard:
/// OctoMap. Autonomous Robots, 2013; there, a hit weighs twice as much as a miss, and rays are followed through the
/// voxels. Here, the voxels are compared with the image. Not thread-safe.
class OccupancyMap
{
 public:
  /// Throws Error for an option that is not valid.
  explicit OccupancyMap(const OccupancyMapOptions& options);
  ~OccupancyMap();

  /// Takes a measurement. `state`: one value per variable, of the time of the measurement. `left_out`: ids of objects
  /// of the world that are known exactly, for example a part that is to be grasped. Their points are not used, and
  /// voxels within SensorView::padding of them are removed. Ids of attached objects count as the robot, and unknown ids
  /// have no effect. Returns the number of voxels that found no room in `max_voxels`; these are the farthest from
  /// the robot's links. Throws Error if an argument is not valid, or if a point is too far away for the size of the
  /// voxels. If it throws, nothing has changed.
  std::size_t add(const DepthImage& image, const SensorView& view, const PlanningScene& scene, const double* state,
                  const std::set<std::string>& left_out = {});
  /// `points`: metres, in the sensor's frame. Points that are not finite are not measured.
  std::size_t add(const std::vector<Eigen::Vector3f>& points, const SensorView& view, const PlanningScene& scene,
                  const double* state, const std::set<std::string>& left_out = {});

  /// Removes the voxels whose distance from one of these objects, of the world or attached, is at most `padding`
  /// (metres). Call it for an object that is attached: its voxels would stay where they are. Errors: as for add().
  void removeNear(const std::set<std::string>& objects, double padding, const PlanningScene& scene,
                  const double* state);

  /// The occupied voxels as cubes in the planning frame. The robot in `state`, with its attached objects, does not
  /// touch them: a voxel that it touches is replaced by those of its parts, cubes of half and of a quarter of its edge,
  /// that are farther from the robot than its largest paddings by at least 1 mm. So the robot can leave such a voxel,
  /// and a motion further into it collides with what is left of it. The voxels beside it are replaced too where they
  /// are within the paddings, and all of them are whole again when the robot is farther from them. If the parts are
  /// more than `max_voxels`, or too far from the origin for an octree, larger parts stay, and the robot touches them.
  /// Null: nothing is known about the robot, and all voxels are whole.
  VoxelCubes cubes(const PlanningScene& scene, const double* state);

  /// The number of occupied voxels.
  std::size_t size() const;
  void clear();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace gpu_planning_scene::core
