#include "node/scene/base_from_tf.h"

#include <cmath>
#include <limits>

#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "scene/message_values.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kLargestLead = 2.5;  // seconds: localisation may publish for a time that is still to come
constexpr double kOldAge = 1.0;       // seconds; localisation and odometry publish many times in this time

/// The values of the virtual joint, and a warning if it cannot reach the pose. Only a planar joint cannot. MoveIt, too,
/// leaves out the rest of the pose.
AssumedBase valuesAt(const Joint& joint, const Eigen::Isometry3d& pose)
{
  try
  {
    return {variablesAt(joint, pose)};
  }
  catch (const Error&)
  {
    const Eigen::Matrix3d directions = planarDirections(joint.axis);
    const Eigen::Vector3d place = directions.transpose() * pose.translation();
    const Eigen::Matrix3d turn = directions.transpose() * pose.linear() * directions;
    return {{place.x(), place.y(), std::atan2(turn(1, 0), turn(0, 0))},
            "the robot's pose by tf leaves the plane of the planar virtual joint '" + joint.name +
                "'; only its part in the plane is used"};
  }
}
}  // namespace

BaseFromTf::BaseFromTf(const FrameLookup& frames, std::shared_ptr<const RobotModel> robot)
  : BaseFromTf([&frames](const StampedFrame& frame) { return frames.find(frame); },
               [] { return static_cast<std::int64_t>(ros::Time::now().toNSec()); }, std::move(robot))
{
}

BaseFromTf::BaseFromTf(Find find, Now now, std::shared_ptr<const RobotModel> robot)
  : find_(std::move(find)), now_(std::move(now)), robot_(std::move(robot))
{
  for (const Joint& joint : robot_->joints())
    if (joint.parent_link < 0 && variableCount(joint.type) > 0)
    {
      joint_ = &joint;
      root_ = robot_->links()[static_cast<std::size_t>(joint.child_link)].name;
    }
}

AssumedBase BaseFromTf::at(std::int64_t stamp)
{
  if (joint_ == nullptr)
    return {};
  return stamp == 0 ? newest() : thatOf(stamp);
}

std::string BaseFromTf::frames() const
{
  return "from '" + robot_->planningFrame() + "' to '" + root_ + "'";
}

AssumedBase BaseFromTf::thatOf(std::int64_t stamp)
{
  const auto find = [this, stamp]() -> std::optional<AssumedBase>
  {
    try
    {
      return valuesAt(*joint_, find_({root_, stamp}).pose);
    }
    catch (const tf2::TransformException&)
    {
      return std::nullopt;
    }
  };
  if (const std::optional<AssumedBase> found = find())
    return *found;
  std::int64_t last = 0;  // the stamp of the newest transform
  try
  {
    last = find_({root_, 0}).stamp;
  }
  catch (const tf2::TransformException&)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!newest_)
      return {{}, "tf has no transform " + frames()};
  }
  if (last <= stamp)
    throw NotKnownYet(
        "tf has no transform " + frames() + " of the time of the measurement" +
        (last == 0 ? "" : "; its newest is " + numberText(1e-9 * static_cast<double>(stamp - last)) + " s older"));
  // It may have come since the first lookup.
  if (const std::optional<AssumedBase> found = find())
    return *found;
  throw Error("the robot's pose of " + numberText(1e-9 * static_cast<double>(last - stamp)) +
              " s before the newest transform " + frames() + " is not available on tf");
}

/// Seconds; 0 for a static transform, which has no stamp; infinite for one from before a simulation began again.
double BaseFromTf::ageOf(const FrameLookup::Found& found) const
{
  const double age = found.stamp == 0 ? 0.0 : 1e-9 * static_cast<double>(now_() - found.stamp);
  return age < -kLargestLead ? std::numeric_limits<double>::infinity() : age;
}

AssumedBase BaseFromTf::newest()
{
  try
  {
    const FrameLookup::Found found = find_({root_, 0});
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!newest_)
        ROS_INFO_STREAM("no state has set the virtual joint '" << joint_->name << "', so tf sets it: the transform "
                                                               << frames());
      newest_ = found;
    }
    AssumedBase base = valuesAt(*joint_, found.pose);
    base.age = ageOf(found);
    if (base.age > kOldAge)
      base.warning += (base.warning.empty() ? "" : "; ") +
                      std::string("the robot's pose comes from tf, and its newest transform ") + frames() + " is " +
                      std::to_string(base.age) + " s old";
    return base;
  }
  catch (const tf2::TransformException&)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!newest_)
      return {{}, "tf has no transform " + frames()};
    AssumedBase base = valuesAt(*joint_, newest_->pose);
    base.age = newest_->stamp == 0 ? std::numeric_limits<double>::infinity() : ageOf(*newest_);
    if (std::isinf(base.age))
      newest_->stamp = 0;  // also when a clock that was set back comes to this time again
    base.warning = "the robot's pose comes from tf, which has lost the transform " + frames() +
                   "; the last one that it had is used";
    return base;
  }
}
}  // namespace gpu_planning_scene::core
