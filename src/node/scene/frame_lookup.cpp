#include "node/scene/frame_lookup.h"

#include <algorithm>
#include <sstream>
#include <thread>

#include "base/text/nearest_key.h"
#include "gpu_planning_scene/error.h"
#include "service/service_errors.h"

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

ros::Time stampOf(const StampedFrame& frame)
{
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(0, frame.stamp)));
  return stamp;
}
}  // namespace

FrameLookup::FrameLookup(const std::string& planning_frame, double timeout, std::function<bool()> stopping,
                         std::function<std::vector<std::string>()> scene_frames)
  : planning_frame_(withoutSlash(planning_frame)),
    timeout_(timeout),
    stopping_(std::move(stopping)),
    scene_frames_(std::move(scene_frames)),
    listener_(buffer_)
{
}

FrameLookup::Clock::time_point FrameLookup::deadline() const
{
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(timeout_, kForEver)));
}

FrameLookup::Found FrameLookup::find(const StampedFrame& frame) const
{
  const geometry_msgs::TransformStamped found =
      buffer_.lookupTransform(planning_frame_, withoutSlash(frame.name), stampOf(frame));
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
    catch (const tf2::TransformException&)
    {
      if (stopping_())
        throw ShuttingDown("shutting down: the lookup of frame '" + frame.name + "' was stopped");
      if (!last)
        continue;
      std::ostringstream text;
      text << fault(withoutSlash(frame.name), stampOf(frame)) << " (waited " << timeout_ << " s: tf_timeout)";
      if (isTooOld(frame) || isSubframeOfScene(frame))
        throw Error(text.str());
      throw NotKnownYet(text.str());
    }
  }
}

std::vector<std::string> FrameLookup::parents(const std::string& frame) const
{
  constexpr std::size_t kMost = 1000;  // as in tf2's own lookups: a wrong tree could have a loop
  std::vector<std::string> found;
  std::string parent;
  for (std::string child = withoutSlash(frame); found.size() < kMost && buffer_._getParent(child, ros::Time(0), parent);
       child = parent)
    found.push_back(parent);
  return found;
}

/// Whether tf has only transforms that are later than the stamp. Then the wanted one will not come any more.
bool FrameLookup::isTooOld(const StampedFrame& frame) const
{
  const std::string name = withoutSlash(frame.name);
  return frame.stamp != 0 && buffer_.canTransform(planning_frame_, name, ros::Time(0)) &&
         stampOf(frame) < buffer_.lookupTransform(planning_frame_, name, ros::Time(0)).header.stamp;
}

/// Whether the name is FRAME/SUBFRAME with a frame of the scene, which lacks this subframe. tf will not bring it.
bool FrameLookup::isSubframeOfScene(const StampedFrame& frame) const
{
  const std::string name = withoutSlash(frame.name);
  const std::size_t slash = name.rfind('/');
  const std::vector<std::string> of_scene = scene_frames_();
  return slash != std::string::npos &&
         std::find(of_scene.begin(), of_scene.end(), name.substr(0, slash)) != of_scene.end();
}

/// Why tf has no transform from the frame to the planning frame, and the remedy.
std::string FrameLookup::fault(const std::string& frame, const ros::Time& stamp) const
{
  const std::string name = "frame '" + frame + "'";
  if (!buffer_._frameExists(frame))
  {
    std::vector<std::string> known;
    buffer_._getFrameStrings(known);
    const std::vector<std::string> of_scene = scene_frames_();
    known.insert(known.end(), of_scene.begin(), of_scene.end());
    const std::string near = didYouMean(frame, known);
    return name + " is neither in the scene nor on tf" +
           (near.empty() ? "; name a link, an object, OBJECT/SUBFRAME, a fixed frame of the scene, or a frame of tf"
                         : near);
  }
  const std::string planning_frame = "planning frame '" + planning_frame_ + "'";
  if (!buffer_._frameExists(planning_frame_))
    return name + " is on tf, but the " + planning_frame + " is not; publish the transform between them";
  if (stamp.isZero() || !buffer_.canTransform(planning_frame_, frame, ros::Time(0)))
    return name + " and the " + planning_frame + " are on tf, but not connected; publish the transform between them";
  std::ostringstream text;
  text.precision(3);
  text << name << " has no transform to the " << planning_frame << " at the stamp " << std::fixed << stamp.toSec()
       << " s; the latest is at " << buffer_.lookupTransform(planning_frame_, frame, ros::Time(0)).header.stamp.toSec()
       << " s: give a time that tf still has, or 0 for the latest";
  return text.str();
}
}  // namespace gpu_planning_scene::core
