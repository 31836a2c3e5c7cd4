#include "node/messages/requested_poses.h"

#include <cmath>
#include <optional>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/inverse_kinematics.h"
#include "model/math_constants.h"
#include "model/rigid_pose.h"
#include "model/text/number_text.h"

namespace gpu_planning_scene::core
{
namespace
{
double toleranceOf(double value, double fallback, const std::string& field)
{
  constexpr double kLeast = 1e-9;
  if (value == 0.0)
    return fallback;
  if (!(std::isfinite(value) && value >= kLeast))
    throw Error(field + " is " + numberText(value) + "; it must be at least 1e-9, or 0 for " + numberText(fallback));
  return value;
}

/// Objects take any quaternion, as in MoveIt. A goal with a wrong quaternion would move the robot to a pose that nobody
/// wants.
Eigen::Quaterniond unitQuaternion(const geometry_msgs::Quaternion& message, const std::string& where)
{
  constexpr double kLargestError = 1e-3;  // of the length: clients write few digits
  const Eigen::Quaterniond rotation(message.w, message.x, message.y, message.z);
  const double length = rotation.coeffs().stableNorm();
  if (!(std::abs(length - 1.0) <= kLargestError))
    throw Error(where + ": the quaternion of the orientation has the length " + numberText(length) +
                "; it must have the length 1 (no rotation is x: 0, y: 0, z: 0, w: 1)");
  return rotation.normalized();
}
}  // namespace

PoseTolerances requestedTolerances(double position_tolerance, double orientation_tolerance)
{
  const PoseTolerances defaults;
  return {toleranceOf(position_tolerance, defaults.position, "position_tolerance"),
          toleranceOf(orientation_tolerance, defaults.orientation, "orientation_tolerance")};
}

LinkFrame requestedFrame(const PlanningScene& scene, const std::string& group, const std::string& name)
{
  const Group& of = scene.robot->group(group);
  return name.empty() ? LinkFrame{tipOf(*scene.robot, of)} : linkFrame(scene, name);
}

const Eigen::Isometry3d& PoseReader::frame(const std_msgs::Header& header)
{
  const StampedFrame name{header.frame_id, static_cast<std::int64_t>(header.stamp.toNSec())};
  const auto known = frames_.find(name);
  if (known != frames_.end())
    return known->second;
  const std::optional<Eigen::Isometry3d> of_scene = scene_.frame(name.name, state_);
  return frames_.emplace(name, of_scene ? *of_scene : lookup_(name)).first->second;
}

KinematicConstraints PoseReader::constraints(const LinkFrame& frame, const geometry_msgs::PoseStamped& message,
                                             const PoseTolerances& tolerances, const std::string& where)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const geometry_msgs::Point& position = message.pose.position;
  pose.translation() = Eigen::Vector3d(position.x, position.y, position.z);
  if (!pose.translation().allFinite())
    throw Error(where + ": the position is not finite");
  if (tolerances.orientation < kPi)
    pose.linear() = unitQuaternion(message.pose.orientation, where).toRotationMatrix();
  try
  {
    pose = this->frame(message.header) * pose;
  }
  catch (const Error& error)
  {
    throw Error(where + ": " + error.what());
  }
  return KinematicConstraints::pose(frame.link, frame.pose, nearestRigid(pose, where), tolerances.position,
                                    tolerances.orientation);
}
}  // namespace gpu_planning_scene::core
