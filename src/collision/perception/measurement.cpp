#include "collision/perception/measurement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kNoRay = std::numeric_limits<float>::infinity();
constexpr float kBlocked = 0.0F;

// Pixels along an edge of a face of the cube around a scanner: 0.22 degrees in the middle of a face, less at its edges.
constexpr int kFacePixels = 512;

void requireView(const SensorView& view)
{
  if (!std::isfinite(view.time))
    throw Error("sensors: the time of a measurement is not finite");
  if (!(view.min_range >= 0.0) || !(view.max_range > view.min_range) || !std::isfinite(view.max_range))
    throw Error("sensors: the range from " + numberText(view.min_range) + " m to " + numberText(view.max_range) +
                " m is empty or not finite");
  if (!(view.padding >= 0.0) || !std::isfinite(view.padding))
    throw Error("sensors: the padding is " + numberText(view.padding) + " m; it must be finite and not negative");
}

void requireImage(const DepthImage& image)
{
  const PinholeCamera& camera = image.camera;
  if (camera.width <= 0 || camera.height <= 0 ||
      image.depths.size() != static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height))
    throw Error("a depth image has " + std::to_string(image.depths.size()) + " depths, but " +
                std::to_string(camera.width) + " x " + std::to_string(camera.height) + " pixels");
  if (!(camera.fx > 0.0) || !(camera.fy > 0.0) || !std::isfinite(camera.fx) || !std::isfinite(camera.fy) ||
      !std::isfinite(camera.cx) || !std::isfinite(camera.cy))
    throw Error("the focal lengths or the principal point of a depth camera are not valid; calibrate the camera");
}

/// The ray of a pixel that is not measured. A single pixel of noise, all of whose neighbours but one are measured,
/// counts as no ray. Several such pixels together may be a body that the camera cannot measure: a dark or reflecting
/// one, or a thin wire.
float unmeasuredRay(const DepthImage& image, int x, int y)
{
  int measured = 0;
  int neighbours = 0;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, image.camera.height - 1); ++row)
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, image.camera.width - 1); ++column)
    {
      if (row == y && column == x)
        continue;
      const float depth = image.depths[image.camera.pixel(column, row)];
      ++neighbours;
      measured += depth > 0.0F ? 1 : 0;
    }
  return neighbours - measured <= 1 ? kNoRay : kBlocked;
}

/// The face of a cube around the sensor that a ray leaves through: 2 axis + (1 if the coordinate is negative).
std::size_t faceOf(const Vector3d& point)
{
  Eigen::Index axis = 0;
  point.cwiseAbs().maxCoeff(&axis);
  return 2 * static_cast<std::size_t>(axis) + (point[axis] < 0.0 ? 1 : 0);
}

/// The rotation into the camera that looks through a face.
Eigen::Matrix3d rotationToFace(std::size_t face)
{
  const auto axis = static_cast<Eigen::Index>(face / 2);
  const Vector3d forward = (face % 2 == 0 ? 1.0 : -1.0) * Vector3d::Unit(axis);
  const Vector3d right = Vector3d::Unit((axis + 1) % 3);
  Eigen::Matrix3d rotation;
  rotation << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  return rotation;
}
}  // namespace

Measurement measurementOf(const DepthImage& image, const SensorView& view)
{
  requireView(view);
  requireImage(image);
  const PinholeCamera& camera = image.camera;
  std::vector<Vector3d> points;
  points.reserve(image.depths.size());
  std::vector<float> rays(image.depths.size());
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
    {
      const auto pixel = camera.pixel(x, y);
      const double depth = static_cast<double>(image.depths[pixel]);
      if (std::isnan(depth) || depth == 0.0)
        rays[pixel] = unmeasuredRay(image, x, y);
      else
        rays[pixel] = depth > 0.0 ? static_cast<float>(std::min(depth, view.max_range)) : kBlocked;
      if (depth >= view.min_range && depth <= view.max_range && depth > 0.0)
        points.emplace_back((x - camera.cx) / camera.fx * depth, (y - camera.cy) / camera.fy * depth, depth);
    }
  Measurement measurement;
  measurement.points = std::move(points);
  measurement.views.push_back({Eigen::Matrix3d::Identity(), DepthView(camera, std::move(rays))});
  return measurement;
}

Measurement measurementOf(const std::vector<Vector3f>& points, const SensorView& view)
{
  requireView(view);
  constexpr double kHalf = 0.5 * kFacePixels;
  const PinholeCamera camera{kFacePixels, kFacePixels, kHalf, kHalf, kHalf - 0.5, kHalf - 0.5};
  std::array<Eigen::Matrix3d, 6> rotations;
  std::array<std::vector<float>, 6> rays;
  for (std::size_t face = 0; face < 6; ++face)
    rotations[face] = rotationToFace(face);
  Measurement measurement;
  measurement.looks_everywhere = true;
  measurement.points.reserve(points.size());
  for (const Vector3f& measured : points)
  {
    Vector3d point = measured.cast<double>();
    const double distance = point.norm();
    if (!std::isfinite(distance) || distance == 0.0)
      continue;
    if (distance > view.max_range)
      point *= view.max_range / distance;
    else if (distance >= view.min_range)
      measurement.points.push_back(point);
    const std::size_t face = faceOf(point);
    if (rays[face].empty())
      rays[face].assign(std::size_t{kFacePixels} * kFacePixels, kNoRay);
    const Vector3d local = rotations[face] * point;
    const auto pixel = [](double ratio)
    { return static_cast<std::size_t>(std::clamp((ratio + 1.0) * kHalf, 0.0, kFacePixels - 1.0)); };
    float& depth = rays[face][pixel(local.y() / local.z()) * kFacePixels + pixel(local.x() / local.z())];
    depth = std::min(depth, static_cast<float>(local.z()));
  }
  for (std::size_t face = 0; face < 6; ++face)
    if (!rays[face].empty())
      measurement.views.push_back({rotations[face], DepthView(camera, std::move(rays[face]), true)});
  return measurement;
}
}  // namespace gpu_planning_scene::core
