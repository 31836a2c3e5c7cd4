#include "node/messages/requested_poses.h"

#include <cmath>
#include <optional>

#include "base/error_place.h"
#include "base/math_constants.h"
#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/inverse_kinematics.h"
#include "model/rigid_pose.h"
#include "scene/constraints_from_message.h"

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
}  // namespace

PoseTolerances requestedTolerances(const RequestField<double>& position, const RequestField<double>& orientation,
                                   const PoseTolerances& defaults)
{
  return {toleranceOf(position.values, defaults.position, position.name),
          toleranceOf(orientation.values, defaults.orientation, orientation.name)};
}

LinkFrame requestedFrame(const PlanningScene& scene, const std::string& group, const std::string& name)
{
  const Group& of = scene.robot->group(group);
  return name.empty() ? LinkFrame{tipOf(*scene.robot, of)} : linkFrame(scene, name);
}

const Eigen::Isometry3d& PoseReader::frame(const StampedFrame& name)
{
  const auto known = frames_.find(name);
  if (known != frames_.end())
    return known->second;
  const std::optional<Eigen::Isometry3d> of_scene = scene_.frame(name.name, state_);
  return frames_.emplace(name, of_scene ? *of_scene : lookup_(name)).first->second;
}

Eigen::Isometry3d PoseReader::pose(const geometry_msgs::PoseStamped& message, bool with_orientation,
                                   const std::string& where)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = constraint_messages::vectorOf(message.pose.position, where + ": the position");
  if (with_orientation)
    pose.linear() = constraint_messages::rotationOf(message.pose.orientation, where).toRotationMatrix();
  const StampedFrame of{message.header.frame_id, static_cast<std::int64_t>(message.header.stamp.toNSec())};
  pose = withErrorPlace(where, [&] { return frame(of); }) * pose;
  return nearestRigid(pose, where);
}

Eigen::Isometry3d PoseReader::pose(const geometry_msgs::PoseStamped& message, const std::string& where)
{
  return pose(message, true, where);
}

KinematicConstraints PoseReader::constraints(const LinkFrame& moved, const geometry_msgs::PoseStamped& message,
                                             const PoseTolerances& tolerances, const std::string& where)
{
  return KinematicConstraints::pose(moved.link, moved.pose, pose(message, tolerances.orientation < kPi, where),
                                    tolerances.position, tolerances.orientation);
}
}  // namespace gpu_planning_scene::core
