#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>

#include <Eigen/Geometry>

#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/kinematic_constraints.h"
#include "gpu_planning_scene/scene_change.h"
#include "scene/link_frame.h"

// Messages with the fields of moveit_msgs/Constraints become constraints. The functions are templates, because MoveIt's
// messages and those of this package have the same fields. ROS is not needed here.
namespace gpu_planning_scene::core
{
/// Finds what the names of a message mean. Both functions throw Error for an unknown name.
struct ConstraintFrames
{
  std::function<Eigen::Isometry3d(const StampedFrame& frame)> pose;  ///< in the planning frame
  std::function<LinkFrame(const std::string& name)> link;
};

/// A rotation of length 1, up to 1e-3. Throws Error that begins with `where` for another length: a wrong quaternion
/// would move the robot to a pose that nobody wants.
Eigen::Quaterniond unitQuaternion(double x, double y, double z, double w, const std::string& where);

namespace constraint_messages
{
template <class Header>
Eigen::Isometry3d poseOf(const Header& header, const ConstraintFrames& frames)
{
  return frames.pose({header.frame_id, static_cast<std::int64_t>(header.stamp.toNSec())});
}

template <class Message>
Eigen::Quaterniond rotationOf(const Message& message, const std::string& where)
{
  return unitQuaternion(message.x, message.y, message.z, message.w, where);
}

template <class Message>
Eigen::Vector3d vectorOf(const Message& message, const std::string& where)
{
  Eigen::Vector3d vector(message.x, message.y, message.z);
  if (!vector.allFinite())
    throw Error(where + " has a number that is not finite");
  return vector;
}

/// Whether a message says what the three numbers of an orientation are. Older messages of MoveIt do not.
template <class Message, class = void>
constexpr bool kHasParameterization = false;
template <class Message>
constexpr bool kHasParameterization<Message, std::void_t<decltype(Message::parameterization)>> = true;

/// Whether a region of a message may have meshes. Those of this package do not.
template <class Volume, class = void>
constexpr bool kHasMeshes = false;
template <class Volume>
constexpr bool kHasMeshes<Volume, std::void_t<decltype(Volume::meshes)>> = true;

template <class Primitive>
std::variant<Sphere, Box> regionOf(const Primitive& primitive, const std::string& where)
{
  const auto& size = primitive.dimensions;
  if (primitive.type == Primitive::SPHERE && size.size() == 1)
    return Sphere{size[0]};
  if (primitive.type == Primitive::BOX && size.size() == 3)
    return Box{Eigen::Vector3d(size[0], size[1], size[2])};
  throw Error(where + ": the region is neither a box with 3 dimensions nor a sphere with 1; use one of these");
}

template <class Message>
PositionConstraint positionFrom(const Message& message, const ConstraintFrames& frames, const std::string& where)
{
  const auto& volume = message.constraint_region;
  if constexpr (kHasMeshes<std::decay_t<decltype(volume)>>)
    if (!volume.meshes.empty())
      throw Error(where + ": the region has a mesh; use a box or a sphere");
  if (volume.primitives.size() != 1 || volume.primitive_poses.size() != 1)
    throw Error(where + ": the region has " + std::to_string(volume.primitives.size()) + " primitives and " +
                std::to_string(volume.primitive_poses.size()) +
                " poses; give one box or sphere with its pose, and further regions as further goals");
  const LinkFrame frame = frames.link(message.link_name);
  const auto& placed = volume.primitive_poses.front();
  PositionConstraint constraint;
  constraint.link = frame.link;
  constraint.point = frame.pose * vectorOf(message.target_point_offset, where + ": target_point_offset");
  constraint.region = regionOf(volume.primitives.front(), where);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = vectorOf(placed.position, where + ": the position of the region");
  pose.linear() = rotationOf(placed.orientation, where + ": the region").toRotationMatrix();
  constraint.pose = poseOf(message.header, frames) * pose;
  return constraint;
}

template <class Message>
OrientationConstraint orientationFrom(const Message& message, const ConstraintFrames& frames, const std::string& where)
{
  const LinkFrame frame = frames.link(message.link_name);
  OrientationConstraint constraint;
  constraint.link = frame.link;
  constraint.frame = frame.pose.linear();
  constraint.axes = poseOf(message.header, frames).linear();
  constraint.wanted = constraint.axes * rotationOf(message.orientation, where).toRotationMatrix();
  constraint.tolerance = {message.absolute_x_axis_tolerance, message.absolute_y_axis_tolerance,
                          message.absolute_z_axis_tolerance};
  if constexpr (kHasParameterization<Message>)
  {
    if (message.parameterization == Message::ROTATION_VECTOR)
      constraint.parameterization = OrientationConstraint::Parameterization::RotationVector;
    else if (message.parameterization != Message::XYZ_EULER_ANGLES)
      throw Error(where + ": parameterization is " + std::to_string(message.parameterization) +
                  "; it must be XYZ_EULER_ANGLES (0) or ROTATION_VECTOR (1)");
  }
  return constraint;
}

template <class Message>
void addJoint(const Message& message, const RobotModel& robot, const std::string& where,
              KinematicConstraints& constraints)
{
  const int variable = robot.variableIndex(message.joint_name);
  if (variable < 0)
    throw Error(where + ": the robot has no variable '" + message.joint_name + "'");
  if (!(std::isfinite(message.position) && message.tolerance_below >= 0.0 && message.tolerance_above >= 0.0))
    throw Error(where + ": the position of joint '" + message.joint_name +
                "' must be finite, and its tolerances at least 0");
  constraints.addJoint(robot, variable, message.position - message.tolerance_below,
                       message.position + message.tolerance_above);
}
}  // namespace constraint_messages

/// `message`: moveit_msgs/Constraints or gpu_planning_scene/Constraints; visibility is not read. Throws Error that
/// begins with `where` for a wrong message, and the errors of `frames` and of KinematicConstraints::validate.
template <class Message>
KinematicConstraints constraintsFrom(const Message& message, const RobotModel& robot, const ConstraintFrames& frames,
                                     const std::string& where)
{
  KinematicConstraints constraints;
  for (std::size_t i = 0; i < message.position_constraints.size(); ++i)
    constraints.positions.push_back(constraint_messages::positionFrom(
        message.position_constraints[i], frames, where + ": position_constraints[" + std::to_string(i) + "]"));
  for (std::size_t i = 0; i < message.orientation_constraints.size(); ++i)
    constraints.orientations.push_back(constraint_messages::orientationFrom(
        message.orientation_constraints[i], frames, where + ": orientation_constraints[" + std::to_string(i) + "]"));
  for (const auto& joint : message.joint_constraints)
    constraint_messages::addJoint(joint, robot, where, constraints);
  constraints.validate(robot, where);
  return constraints;
}
}  // namespace gpu_planning_scene::core
