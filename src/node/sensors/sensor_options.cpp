#include "node/sensors/sensor_options.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <ros/names.h>

#include "base/text/name_list.h"
#include "base/text/nearest_key.h"
#include "gpu_planning_scene/error.h"
#include "node/parameters/parameter_values.h"

namespace gpu_planning_scene::core
{
namespace
{
using XmlRpc::XmlRpcValue;

const std::vector<std::string> kSensorKeys = {"image_topic",
                                              "camera_info_topic",
                                              "point_cloud_topic",
                                              "near_clipping_plane_distance",
                                              "far_clipping_plane_distance",
                                              "min_range",
                                              "max_range",
                                              "padding_offset",
                                              "max_update_rate",
                                              "max_silence",
                                              "point_subsample",
                                              "sensor_plugin",  // the topic's name tells the kind of the sensor
                                              "queue_size",     // only the newest measurement waits
                                              "ns",
                                              "name"};
// Keys of MoveIt's updaters that have no effect here: points of the robot are found by its exact geometry.
const std::vector<std::string> kIgnoredKeys = {
    "filtered_cloud_topic", "filtered_cloud_use_color", "filtered_cloud_keep_organized", "shadow_threshold",
    "padding_scale",        "skip_vertical_pixels",     "skip_horizontal_pixels"};

constexpr double kSilentPeriods = 3.0;  // of max_update_rate: the default of max_silence is at least so long

/// An entry of the list.
class Entry
{
 public:
  Entry(XmlRpcValue& value, std::string where) : value_(value), where_(std::move(where))
  {
    if (value_.getType() != XmlRpcValue::TypeStruct)
      throw Error(where_ + " is not a map with image_topic or point_cloud_topic");
  }

  bool has(const std::string& key) const { return value_.hasMember(key); }

  std::string text(const std::string& key) const
  {
    if (!has(key))
      return "";
    if (value_[key].getType() != XmlRpcValue::TypeString)
      throw Error(where_ + ": " + key + " is not a string");
    return static_cast<std::string>(value_[key]);
  }

  double number(const std::string& key, double fallback, double least) const
  {
    if (!has(key))
      return fallback;
    XmlRpcValue& value = value_[key];
    if (value.getType() != XmlRpcValue::TypeInt && value.getType() != XmlRpcValue::TypeDouble)
      throw Error(where_ + ": " + key + " is not a number");
    const double number =
        value.getType() == XmlRpcValue::TypeInt ? static_cast<int>(value) : static_cast<double>(value);
    if (!std::isfinite(number) || number < least)
      throw Error(where_ + ": " + key + " is not finite, or below " + std::to_string(static_cast<int>(least)));
    return number;
  }

  /// Throws Error for an unknown key. Returns the keys without an effect.
  std::vector<std::string> ignoredKeys() const
  {
    std::vector<std::string> ignored;
    for (const auto& member : value_)
      if (contains(kIgnoredKeys, member.first))
        ignored.push_back(member.first);
      else if (!contains(kSensorKeys, member.first))
      {
        const std::string meant = didYouMean(member.first, kSensorKeys);
        throw Error(where_ + " has the unknown key '" + member.first + "'" +
                    (meant.empty() ? "; there are: " + nameList(kSensorKeys) : meant));
      }
    return ignored;
  }

  const std::string& where() const { return where_; }

 private:
  XmlRpcValue& value_;
  const std::string where_;
};

SensorOptions sensorFrom(const Entry& entry, const ros::NodeHandle& node)
{
  const std::string image = entry.text("image_topic");
  const std::string cloud = entry.text("point_cloud_topic");
  if (image.empty() == cloud.empty())
    throw Error(entry.where() + " needs image_topic (depth images) or point_cloud_topic, one of the two");
  SensorOptions sensor;
  sensor.topic = node.resolveName(image.empty() ? cloud : image);
  if (!image.empty())
    sensor.camera_info_topic =
        entry.has("camera_info_topic")
            ? node.resolveName(entry.text("camera_info_topic"))
            : ros::names::append(ros::names::parentNamespace(sensor.topic), "camera_info");  // as image_transport
  sensor.min_range =
      entry.number("min_range", entry.number("near_clipping_plane_distance", sensor.min_range, 0.0), 0.0);
  sensor.max_range = entry.number("max_range", entry.number("far_clipping_plane_distance", sensor.max_range, 0.0), 0.0);
  if (sensor.max_range <= sensor.min_range)
    throw Error(entry.where() + ": the range ends before it begins");
  sensor.padding = entry.number("padding_offset", sensor.padding, 0.0);
  sensor.max_rate = entry.number("max_update_rate", sensor.max_rate, 0.0);
  if (sensor.max_rate > 0.0)
    sensor.max_silence = std::max(sensor.max_silence, kSilentPeriods / sensor.max_rate);
  sensor.max_silence = entry.number("max_silence", sensor.max_silence, 0.0);
  const double step = entry.number("point_subsample", 1.0, 1.0);
  if (step != std::floor(step) || step > 1e6)
    throw Error(entry.where() + ": point_subsample is not an integer from 1 to 1000000");
  sensor.step = static_cast<std::size_t>(step);
  return sensor;
}

Eigen::AlignedBox3d regionFrom(const ros::NodeHandle& own)
{
  std::vector<double> corners;
  if (!own.hasParam("octomap_region"))
    return OccupancyMapOptions().region;
  if (!own.getParam("octomap_region", corners) || corners.size() != 6 ||
      !std::all_of(corners.begin(), corners.end(), [](double value) { return std::isfinite(value); }))
    throw Error("parameter ~octomap_region is not a list of six numbers: [MIN_X, MIN_Y, MIN_Z, MAX_X, MAX_Y, MAX_Z]");
  Eigen::AlignedBox3d region;
  region.min() = Eigen::Map<const Eigen::Vector3d>(corners.data());
  region.max() = Eigen::Map<const Eigen::Vector3d>(corners.data() + 3);
  if (region.isEmpty())
    throw Error("parameter ~octomap_region is empty; give the smaller coordinates first");
  return region;
}
}  // namespace

SensorsOptions sensorsFromParameters(const ros::NodeHandle& node, const ros::NodeHandle& own,
                                     const std::string& planning_frame, std::vector<std::string>& warnings)
{
  SensorsOptions options;
  options.map.resolution = positiveParameter(own, "octomap_resolution", options.map.resolution);
  options.map.decay = lengthParameter(own, "octomap_decay", options.map.decay);
  options.map.region = regionFrom(own);
  options.map.max_voxels = countParameter(own, "limits/voxels", options.map.max_voxels, 1, 1'000'000'000);
  const std::string frame = textParameter(own, "octomap_frame", planning_frame);
  if (frame != planning_frame)
    throw Error("parameter ~octomap_frame is '" + frame + "', but the octomap is in the planning frame '" +
                planning_frame + "'; remove the parameter");
  XmlRpcValue list;
  if (!own.getParam("sensors", list))
    return options;
  const std::string name = "parameter " + own.resolveName("sensors");
  if (list.getType() != XmlRpcValue::TypeArray)
    throw Error(name + " is not a list of sensors");
  for (int i = 0; i < list.size(); ++i)
  {
    const Entry entry(list[i], name + ": entry " + std::to_string(i));
    const std::vector<std::string> ignored = entry.ignoredKeys();
    if (!ignored.empty())
      warnings.push_back(entry.where() + ": these keys have no effect: " + nameList(ignored));
    options.sensors.push_back(sensorFrom(entry, node));
  }
  if (options.sensors.empty())
    return options;
  for (const char* other : {"follow", "monitor"})
    if (!textParameter(own, other, "").empty())
      throw Error("parameters ~sensors and ~" + std::string(other) +
                  " exclude each other: the octomap comes with the scene of the other node; unset one of the two");
  return options;
}
}  // namespace gpu_planning_scene::core
