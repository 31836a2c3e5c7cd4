#include "node/scene/frame_lookup.h"

#include <algorithm>
#include <thread>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::chrono::milliseconds kPause(10);
constexpr double kForEver = 1e8;  // seconds; longer waits would overflow the clock

/// tf2 accepts no leading slash, but MoveIt's users may write one.
std::string withoutSlash(const std::string& name)
{
  return name.empty() || name.front() != '/' ? name : name.substr(1);
}

/// The error in one line.
std::string reasonOf(const tf2::TransformException& error)
{
  std::string text = error.what();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}
}  // namespace

FrameLookup::FrameLookup(std::string planning_frame, double timeout, std::function<bool()> stopping)
  : planning_frame_(withoutSlash(planning_frame)), timeout_(timeout), stopping_(std::move(stopping)), listener_(buffer_)
{
}

FrameLookup::Clock::time_point FrameLookup::deadline() const
{
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(timeout_, kForEver)));
}

FrameLookup::Found FrameLookup::find(const StampedFrame& frame) const
{
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(0, frame.stamp)));
  const geometry_msgs::TransformStamped found =
      buffer_.lookupTransform(planning_frame_, withoutSlash(frame.name), stamp);
  const geometry_msgs::Vector3& place = found.transform.translation;
  const geometry_msgs::Quaternion& turn = found.transform.rotation;
  const Eigen::Quaterniond rotation(turn.w, turn.x, turn.y, turn.z);
  return {Eigen::Translation3d(place.x, place.y, place.z) * rotation.normalized(),
          static_cast<std::int64_t>(found.header.stamp.toNSec())};
}

/// Polls tf2. The wait of tf2 itself uses ROS time, and never ends if ROS time stands still.
Eigen::Isometry3d FrameLookup::operator()(const StampedFrame& frame, Clock::time_point until) const
{
  for (;; std::this_thread::sleep_for(kPause))
  {
    const bool last = Clock::now() >= until;
    try
    {
      return find(frame).pose;
    }
    catch (const tf2::TransformException& error)
    {
      if (stopping_())
        throw Error("shutting down: the lookup of frame '" + frame.name + "' was stopped");
      if (!last)
        continue;
      std::string when = "at the latest time";
      if (frame.stamp != 0)
        when = "at " + std::to_string(1e-9 * static_cast<double>(frame.stamp)) + " s";
      throw Error("frame '" + frame.name + "': not in the scene, and tf found no transform to the planning frame '" +
                  planning_frame_ + "' " + when + " within " + std::to_string(timeout_) +
                  " s (tf_timeout): " + reasonOf(error));
    }
  }
}
}  // namespace gpu_planning_scene::core
