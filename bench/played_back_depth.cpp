// played_back_depth: plays a measured depth image to the map of sensors; see --help.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <set>

#include "base/seconds_since.h"
#include "benchmark/statistics.h"
#include "command_line/command_line.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/occupancy_map.h"
#include "support/depth_camera.h"
#include "support/test_scenes.h"

using namespace gpu_planning_scene::core;

namespace
{
constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr int kPeriod = 90;          // frames in which the camera pans to and fro, and the robot swings
constexpr int kSheetFrames = 20;     // of a period in which a sheet hides a part of the image
constexpr float kSheetDepth = 0.9F;  // metres
constexpr double kPadding = 0.03;    // metres
constexpr int kViewsToClear = 3;

using Voxel = std::array<long, 3>;

/// A disparity image and its camera, as in the Middlebury stereo datasets.
struct Recording
{
  PinholeCamera camera;
  std::vector<float> depths;  // metres; NaN: not measured
};

/// Reads a portable float map of one channel: rows from below, in the order of bytes of this machine.
Recording readRecording(const CommandLine& arguments)
{
  const std::string file = arguments.required("--disparities");
  std::ifstream in(file, std::ios::binary);
  std::string kind;
  Recording recording;
  double scale = 0.0;
  if (!(in >> kind >> recording.camera.width >> recording.camera.height >> scale) || kind != "Pf" || scale >= 0.0 ||
      recording.camera.width < kWidth || recording.camera.height < kHeight)
    throw Error(file + ": not a little-endian portable float map (Pf) of at least 640 x 480 pixels");
  in.get();
  const auto width = static_cast<std::size_t>(recording.camera.width);
  const auto height = static_cast<std::size_t>(recording.camera.height);
  recording.depths.resize(width * height);
  for (std::size_t row = height; row-- > 0;)
    in.read(reinterpret_cast<char*>(&recording.depths[row * width]),
            static_cast<std::streamsize>(width * sizeof(float)));
  if (!in)
    throw Error(file + ": the file ends before the last row");
  recording.camera.fx = recording.camera.fy = arguments.number("--focal-length", 0.0, 1.0, 1e6);
  recording.camera.cx = arguments.number("--cx", 0.0, 0.0, 1e6);
  recording.camera.cy = arguments.number("--cy", 0.0, 0.0, 1e6);
  const double baseline = arguments.number("--baseline", 0.0, 1e-6, 1e3);
  const double offset = arguments.number("--offset", 0.0, -1e6, 1e6);
  for (float& value : recording.depths)
  {
    const double depth = baseline * recording.camera.fx / (static_cast<double>(value) + offset);
    value = std::isfinite(depth) && depth > 0.0 ? static_cast<float>(depth) : std::nanf("");
  }
  return recording;
}

/// The part of the recording that a camera of 640 x 480 pixels sees.
DepthImage windowOf(const Recording& recording, int left, int top)
{
  DepthImage image{recording.camera, {}};
  image.camera.width = kWidth;
  image.camera.height = kHeight;
  image.camera.cx -= left;
  image.camera.cy -= top;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      image.depths.push_back(recording.depths[recording.camera.pixel(left + x, top + y)]);
  return image;
}

bool isInImage(const PinholeCamera& camera, const Eigen::Vector3d& point)
{
  const double x = camera.cx + camera.fx * point.x() / point.z();
  const double y = camera.cy + camera.fy * point.y() / point.z();
  return x >= 0.0 && y >= 0.0 && x <= camera.width - 1 && y <= camera.height - 1;
}

bool hasNeighbour(const std::set<Voxel>& voxels, const Voxel& voxel)
{
  for (long x = -1; x <= 1; ++x)
    for (long y = -1; y <= 1; ++y)
      for (long z = -1; z <= 1; ++z)
        if (voxels.count({voxel[0] + x, voxel[1] + y, voxel[2] + z}) != 0)
          return true;
  return false;
}

/// A voxel that the sheet was in.
struct SheetVoxel
{
  int last_image = -1;
  int views_behind = 0;  // images since then that saw through the voxel
};

struct Differences
{
  std::size_t compared = 0;      // voxels with points
  std::size_t missing = 0;       // of them
  std::size_t invented = 0;      // voxels without points
  std::size_t seen_through = 0;  // voxels of the sheet, in so many images that they must be gone
  std::size_t left_behind = 0;   // of them
  std::size_t sheet = 0;         // voxels of the sheet, in each period
  std::size_t stayed = 0;        // of them, at the end of the period
  std::size_t touching = 0;      // states of the robot that touch the map

  std::size_t sum() const { return missing + invented + left_behind + touching; }
};

/// Plays images to a map, and compares it with their points.
class Playback
{
 public:
  Playback(Recording recording, double range, double resolution)
    : recording_(std::move(recording)), range_(range), map_(optionsOf(resolution)), resolution_(resolution)
  {
  }

  /// Returns the seconds that the map took.
  double play(int number)
  {
    phase_ = number % kPeriod;
    const double turn = 2.0 * M_PI * phase_ / kPeriod;
    state_.assign(scene_->robot->variables().size(), 0.0);
    state_[0] = 1.2 * std::sin(turn);
    state_[1] = 0.5;
    const double pan = 0.5 - 0.5 * std::cos(turn);
    DepthImage image = windowOf(recording_, static_cast<int>(pan * (recording_.camera.width - kWidth)),
                                static_cast<int>(pan * (recording_.camera.height - kHeight)));
    addRobotAndSheet(image, number);
    for (auto& [voxel, sheet] : sheet_)
      if (sheet.last_image != number && isSeenThrough(image, voxel))
        differences_.seen_through += ++sheet.views_behind == kViewsToClear ? 1 : 0;
    const auto start = std::chrono::steady_clock::now();
    const double time = number / 15.0;  // 15 images a second
    map_.add(image, {pose_, time, time, 0.0, range_, kPadding}, *scene_, state_.data());
    const std::vector<PlacedShape> cubes = map_.cubes(*scene_, state_.data()).cubes;
    const double seconds = secondsSince(start);
    compare(cubes, number);
    if (phase_ % 10 == 0 && touches(cubes))
      ++differences_.touching;
    return seconds;
  }

  const Differences& differences() const { return differences_; }
  std::size_t voxels() const { return map_.size(); }

 private:
  static constexpr int kSheetBegins = kPeriod / 2;

  static OccupancyMapOptions optionsOf(double resolution)
  {
    OccupancyMapOptions options;
    options.resolution = resolution;
    return options;
  }

  Voxel voxelOf(const Eigen::Vector3d& point) const
  {
    const Eigen::Vector3d place = point / resolution_;
    return {std::lround(std::floor(place.x())), std::lround(std::floor(place.y())), std::lround(std::floor(place.z()))};
  }

  Eigen::Vector3d centreOf(const Voxel& voxel) const
  {
    const Eigen::Vector3d corner(static_cast<double>(voxel[0]), static_cast<double>(voxel[1]),
                                 static_cast<double>(voxel[2]));
    return resolution_ * (corner + Eigen::Vector3d::Constant(0.5));
  }

  /// Notes the voxels of the other points.
  void addRobotAndSheet(DepthImage& image, int number)
  {
    const DepthImage robot = depthImageOf(*scene_, state_.data(), image.camera, pose_);
    const bool has_sheet = phase_ >= kSheetBegins && phase_ < kSheetBegins + kSheetFrames;
    seen_.clear();
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
      {
        float& depth = image.depths[image.camera.pixel(x, y)];
        const float of_robot = robot.depths[image.camera.pixel(x, y)];
        const bool is_sheet = has_sheet && x >= 40 && x < 600 && y >= 20 && y < 300;
        if (is_sheet)
          depth = kSheetDepth;
        const bool is_robot = std::isfinite(of_robot) && !(depth < of_robot);
        if (is_robot)
          depth = of_robot;
        if (is_robot || !(static_cast<double>(depth) <= range_))
          continue;
        const Voxel voxel = voxelOf(pose_ * pointOf(image, x, y));
        if (is_sheet)
          sheet_[voxel] = {number, 0};
        else
          measured_.insert(voxel);
        if (isInImage(image.camera, pose_.inverse() * centreOf(voxel)))
          seen_.insert(voxel);
      }
  }

  /// Whether all pixels around the voxel are measured, well behind it.
  bool isSeenThrough(const DepthImage& image, const Voxel& voxel) const
  {
    Eigen::AlignedBox2d pixels;
    double behind = 0.0;
    for (int corner = 0; corner < 8; ++corner)
    {
      const Eigen::Vector3d offset(corner & 1, corner >> 1 & 1, corner >> 2);
      const Eigen::Vector3d point =
          pose_.inverse() * (centreOf(voxel) + resolution_ * (offset - Eigen::Vector3d::Constant(0.5)));
      pixels.extend(Eigen::Vector2d(image.camera.cx + image.camera.fx * point.x() / point.z(),
                                    image.camera.cy + image.camera.fy * point.y() / point.z()));
      behind = std::max(behind, point.z() + 0.5 * resolution_);
    }
    const Eigen::Array2d margin = 2.0 + 0.2 * pixels.sizes().array();  // the map looks at a box around the voxel
    const Eigen::Vector2i least = (pixels.min().array() - margin).floor().cast<int>();
    const Eigen::Vector2i most = (pixels.max().array() + margin).ceil().cast<int>();
    if (least.minCoeff() < 0 || most.x() >= kWidth || most.y() >= kHeight)
      return false;
    for (int y = least.y(); y <= most.y(); ++y)
      for (int x = least.x(); x <= most.x(); ++x)
        if (!(static_cast<double>(image.depths[image.camera.pixel(x, y)]) > behind))
          return false;
    return true;
  }

  void compare(const std::vector<PlacedShape>& cubes, int number)
  {
    std::set<Voxel> found;
    for (const PlacedShape& cube : cubes)
      found.insert(voxelOf(cube.pose.translation()));
    for (const Voxel& voxel : found)
      if (!hasNeighbour(measured_, voxel))
      {
        const auto sheet = sheet_.find(voxel);
        differences_.invented += sheet == sheet_.end() ? 1 : 0;
        differences_.left_behind += sheet != sheet_.end() && sheet->second.views_behind >= kViewsToClear ? 1 : 0;
      }
    for (const Voxel& voxel : seen_)
      if (!hasNeighbour(found, voxel) && !isNearRobot(voxel))
        ++differences_.missing;
    differences_.compared += seen_.size();
    if (phase_ == kPeriod - 1)
      for (const auto& [voxel, sheet] : sheet_)
      {
        differences_.sheet += sheet.last_image > number - kPeriod ? 1 : 0;
        differences_.stayed += sheet.last_image > number - kPeriod && found.count(voxel) != 0 ? 1 : 0;
      }
  }

  bool collides(const std::vector<PlacedShape>& shapes) const
  {
    PlanningScene scene = *scene_;
    if (!shapes.empty())
      scene.objects = {{"shapes", Eigen::Isometry3d::Identity(), shapes}};
    return CpuChecker(std::make_shared<const PlanningScene>(scene)).check(state_.data(), 1).valid.front() == 0;
  }

  bool touches(const std::vector<PlacedShape>& cubes) const
  {
    if (collides({}))
      throw Error("the robot collides with itself, so nothing is known about the map");
    return !cubes.empty() && collides(cubes);
  }

  /// Whether points of this voxel may count as points of the robot.
  bool isNearRobot(const Voxel& voxel) const
  {
    return collides({{Sphere{kPadding + 1.5 * resolution_}, Eigen::Isometry3d(Eigen::Translation3d(centreOf(voxel)))}});
  }

  const Recording recording_;
  const double range_;
  OccupancyMap map_;
  const double resolution_;
  const std::shared_ptr<const PlanningScene> scene_ =
      std::make_shared<const PlanningScene>(testScene("arm_boxes").scene->robot);
  const Eigen::Isometry3d pose_ = cameraPose({-2.0, 0.0, 0.8}, {2.0, 0.0, 0.4});
  int phase_ = 0;
  std::vector<double> state_;
  std::set<Voxel> measured_;  // by any image
  std::map<Voxel, SheetVoxel> sheet_;
  std::set<Voxel> seen_;  // by the last image
  Differences differences_;
};

void run(const CommandLine& arguments)
{
  const auto images = static_cast<int>(arguments.count("--images", std::size_t{3} * kPeriod, 1, 1000000));
  Playback playback(readRecording(arguments), arguments.number("--range", 4.0, 0.1, 100.0),
                    arguments.number("--resolution", 0.05, 0.001, 1.0));
  std::vector<double> seconds;
  for (int i = 0; i < images; ++i)
    seconds.push_back(playback.play(i));
  const Differences& found = playback.differences();
  std::printf(
      "| images | voxels at the end | measured voxels | missing | invented | voxels of the sheet | of them seen "
      "through %d times | of these left | of all left at the end | states that touch the map | ms of an image: median, "
      "largest |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n"
      "| %d | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %.1f, %.1f |\n",
      kViewsToClear, images, playback.voxels(), found.compared, found.missing, found.invented, found.sheet,
      found.seen_through, found.left_behind, found.stayed, found.touching, 1e3 * benchmark::median(seconds),
      1e3 * benchmark::percentile(seconds, 1.0));
  if (found.sum() != 0)
    throw Error("the map is not as the images");
}
}  // namespace

int main(int argc, char** argv)
{
  const Tool tool{
      "played_back_depth",
      "--disparities FILE --focal-length F --cx X --cy Y --baseline B [--offset D] [--images N] [--range R]\n"
      "[--resolution L]",
      "Plays a measured disparity image, for example of the Middlebury stereo datasets, to the map of sensors. A\n"
      "camera of 640 x 480 pixels pans over the image, the demo's arm swings in front of it, and a sheet comes and\n"
      "goes. The map is compared with the points of the images: all their voxels must be there, within one voxel, and\n"
      "no others. A voxel of the sheet must be gone after three images that see through it. Prints a Markdown table.\n"
      "Exit code: 0 no difference, 1 a difference or another error, 2 bad usage.",
      {{"--disparities", "FILE", "a portable float map (Pf): pixels; not finite: not measured"},
       {"--focal-length", "F", "pixels"},
       {"--cx", "X", "pixels: the principal point of the left camera"},
       {"--cy", "Y", "pixels"},
       {"--baseline", "B", "metres"},
       {"--offset", "D", "pixels: difference of the principal points (default 0)"},
       {"--images", "N", "number of images (default 270)"},
       {"--range", "R", "metres: farther points are not used (default 4)"},
       {"--resolution", "L", "metres: edge length of a voxel (default 0.05)"}},
      run};
  return runTool(tool, argc, argv);
}
