#include "node/messages/sensor_messages.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include <sensor_msgs/image_encodings.h>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace encodings = sensor_msgs::image_encodings;

/// Offset of the field in a point, in bytes.
std::size_t offsetOf(const sensor_msgs::PointCloud2& message, const std::string& name)
{
  for (const sensor_msgs::PointField& field : message.fields)
    if (field.name == name && field.datatype == sensor_msgs::PointField::FLOAT32 &&
        std::size_t{field.offset} + sizeof(float) <= message.point_step)
      return field.offset;
  throw Error("the point cloud has no FLOAT32 field '" + name + "' inside point_step");
}

/// Metres: a pixel of REP 118's two encodings.
float depthFrom(float metres)
{
  return metres;
}

float depthFrom(std::uint16_t millimetres)
{
  return 0.001F * static_cast<float>(millimetres);
}

template <class Pixel>
std::vector<float> depthsOf(const sensor_msgs::Image& message)
{
  const std::uint64_t row = std::uint64_t{message.width} * sizeof(Pixel);
  if (message.step < row || message.data.size() < std::uint64_t{message.height} * message.step)
    throw Error("the data of the depth image (" + std::to_string(message.data.size()) +
                " bytes) is too short for its " + std::to_string(message.height) + " rows of " +
                std::to_string(message.width) + " pixels");
  std::vector<float> depths;
  depths.reserve(std::size_t{message.width} * message.height);
  for (std::size_t y = 0; y < message.height; ++y)
    for (std::size_t x = 0; x < message.width; ++x)
    {
      Pixel pixel{};
      std::memcpy(&pixel, message.data.data() + y * message.step + x * sizeof(Pixel), sizeof(Pixel));
      depths.push_back(depthFrom(pixel));
    }
  return depths;
}
}  // namespace

std::vector<Eigen::Vector3f> pointsOf(const sensor_msgs::PointCloud2& message, std::size_t step)
{
  if (message.is_bigendian)
    throw Error("the point cloud has big-endian numbers; send little-endian numbers");
  const std::array<std::size_t, 3> offsets = {{offsetOf(message, "x"), offsetOf(message, "y"), offsetOf(message, "z")}};
  const std::uint64_t row = std::uint64_t{message.width} * message.point_step;
  if (message.row_step < row || message.data.size() < std::uint64_t{message.height} * message.row_step)
    throw Error("the data of the point cloud (" + std::to_string(message.data.size()) +
                " bytes) is too short for its " + std::to_string(message.height) + " rows of " +
                std::to_string(message.width) + " points");
  std::vector<Eigen::Vector3f> points;
  if (row == 0)
    return points;  // without a loop over `height`, which may be any number here
  const std::size_t count = std::size_t{message.width} * message.height;
  points.reserve(count / step + 1);
  for (std::size_t i = 0; i < count; i += step)
  {
    const std::uint8_t* at =
        message.data.data() + i / message.width * message.row_step + i % message.width * message.point_step;
    Eigen::Vector3f& point = points.emplace_back();
    for (int axis = 0; axis < 3; ++axis)
      std::memcpy(&point[axis], at + offsets[static_cast<std::size_t>(axis)], sizeof(float));
  }
  return points;
}

PinholeCamera cameraOf(const sensor_msgs::CameraInfo& info)
{
  if (info.binning_x > 1 || info.binning_y > 1 || info.roi.x_offset != 0 || info.roi.y_offset != 0 ||
      (info.roi.width != 0 && info.roi.width != info.width) || (info.roi.height != 0 && info.roi.height != info.height))
    throw Error("camera_info has binning or a region of interest; send the whole image of the depth camera");
  PinholeCamera camera;
  camera.width = static_cast<int>(info.width);
  camera.height = static_cast<int>(info.height);
  const bool is_distorted = std::any_of(info.D.begin(), info.D.end(), [](double value) { return value != 0.0; });
  if (is_distorted && !(info.P[0] > 0.0))
    throw Error("camera_info has distortion, but no projection matrix P; send rectified images with their camera_info");
  const bool is_rectified = info.P[0] > 0.0;  // P has rows of four numbers, K of three
  if (is_rectified && (info.P[3] != 0.0 || info.P[7] != 0.0))
    throw Error(
        "camera_info is of the second camera of a stereo pair: P[3] or P[7] is not 0, so its frame is that of the "
        "first camera; send the depth image of the first camera");
  camera.fx = is_rectified ? info.P[0] : info.K[0];
  camera.cx = is_rectified ? info.P[2] : info.K[2];
  camera.fy = is_rectified ? info.P[5] : info.K[4];
  camera.cy = is_rectified ? info.P[6] : info.K[5];
  return camera;
}

DepthImage depthImageOf(const sensor_msgs::Image& message, const PinholeCamera& camera)
{
  if (message.is_bigendian)
    throw Error("the depth image has big-endian numbers; send little-endian numbers");
  if (message.width == 0 || message.height == 0)
    throw Error("the depth image has no pixels");
  if (static_cast<int>(message.width) != camera.width || static_cast<int>(message.height) != camera.height)
    throw Error("the depth image has " + std::to_string(message.width) + " x " + std::to_string(message.height) +
                " pixels, but camera_info " + std::to_string(camera.width) + " x " + std::to_string(camera.height));
  if (message.encoding == encodings::TYPE_32FC1)
    return {camera, depthsOf<float>(message)};
  if (message.encoding == encodings::TYPE_16UC1 || message.encoding == encodings::MONO16)
    return {camera, depthsOf<std::uint16_t>(message)};
  throw Error("the depth image has the encoding '" + message.encoding +
              "'; send 32FC1 (metres) or 16UC1 (millimetres)");
}
}  // namespace gpu_planning_scene::core
