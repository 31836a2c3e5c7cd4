#include "node/frame_lookup.h"

#include <algorithm>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene
{
namespace
{
/// tf2 knows no leading slash, which MoveIt's users may give.
std::string withoutSlash(const std::string& name)
{
  return name.empty() || name.front() != '/' ? name : name.substr(1);
}

/// In one line.
std::string reasonOf(const tf2::TransformException& error)
{
  std::string text = error.what();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}
}  // namespace

FrameLookup::FrameLookup(std::string planning_frame, double timeout)
  : planning_frame_(withoutSlash(planning_frame)), timeout_(timeout), listener_(buffer_)
{
}

FrameLookup::Clock::time_point FrameLookup::deadline() const
{
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_));
}

Eigen::Isometry3d FrameLookup::operator()(const FrameAt& frame, Clock::time_point until) const
{
  const double left = std::max(0.0, std::chrono::duration<double>(until - Clock::now()).count());
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(0, frame.stamp)));
  try
  {
    const geometry_msgs::Transform found =
        buffer_.lookupTransform(planning_frame_, withoutSlash(frame.name), stamp, ros::Duration(left)).transform;
    const Eigen::Quaterniond rotation(found.rotation.w, found.rotation.x, found.rotation.y, found.rotation.z);
    return Eigen::Translation3d(found.translation.x, found.translation.y, found.translation.z) * rotation.normalized();
  }
  catch (const tf2::TransformException& error)
  {
    std::string when = "at the latest time";
    if (frame.stamp != 0)
      when = "at " + std::to_string(stamp.toSec()) + " s";
    throw Error("frame '" + frame.name + "': the scene has no such frame, and within " + std::to_string(timeout_) +
                " s (tf_timeout) tf did not know it in the planning frame '" + planning_frame_ + "' " + when + ": " +
                reasonOf(error));
  }
}
}  // namespace gpu_planning_scene
