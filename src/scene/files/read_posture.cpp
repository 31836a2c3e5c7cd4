#include <cmath>
#include <utility>

#include "scene/files/scene_keys.h"
#include "scene/files/scene_reader.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kNanoseconds = 1e9;  // in a second

/// A time or duration: seconds, or MoveIt's map of secs and nsecs (ROS 2: sec and nanosec).
std::int64_t readTime(const YamlValue* value, double least, double most)
{
  if (value == nullptr)
    return 0;
  double seconds = 0.0;
  if (value->kind() == YamlValue::Kind::Map)
  {
    checkKeys(*value, SceneMap::Time, nullptr);
    for (const auto& [key, unit] : {std::pair("secs", 1.0), std::pair("sec", 1.0), std::pair("nsecs", kNanoseconds),
                                    std::pair("nanosec", kNanoseconds)})
      if (const YamlValue* const part = value->find(key))
        seconds += part->number() / unit;
  }
  else
    seconds = value->number();
  if (!(seconds >= least && seconds <= most))
    value->fail("a time is beyond the range of ROS");
  return std::llround(seconds * kNanoseconds);
}

std::vector<double> readNumbers(const YamlValue& point, const char* key)
{
  std::vector<double> numbers;
  if (const YamlValue* const values = point.find(key))
    for (const YamlValue& value : values->items())
      numbers.push_back(value.number());
  return numbers;
}
}  // namespace

JointTrajectory readTrajectory(const YamlValue& value, const SceneReader& reader)
{
  checkKeys(value, SceneMap::Trajectory, reader.warnings);
  JointTrajectory trajectory;
  if (const YamlValue* const header = value.find("header"))
  {
    if (const YamlValue* const frame = frameOf(header))
      trajectory.frame_id = frame->text();
    trajectory.stamp = readTime(header->find("stamp"), 0.0, 4294967295.0);
  }
  if (const YamlValue* const names = value.find("joint_names"))
    for (const YamlValue& name : names->items())
      trajectory.joint_names.push_back(name.text());
  if (const YamlValue* const points = value.find("points"))
    for (const YamlValue& point : points->items())
    {
      checkKeys(point, SceneMap::TrajectoryPoint, reader.warnings);
      trajectory.points.push_back({readNumbers(point, "positions"), readNumbers(point, "velocities"),
                                   readNumbers(point, "accelerations"), readNumbers(point, "effort"),
                                   readTime(point.find("time_from_start"), -2147483647.0, 2147483647.0)});
    }
  return trajectory;
}
}  // namespace gpu_planning_scene::core
