#include "model/point_rates.h"

#include <algorithm>

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// The angular velocities, in the frame of the joint, at which a rotation turns while each value of its quaternion
/// (x, y, z, w) changes: the vector part of 2 e conj(q) / |q|^2 for each unit quaternion e.
Eigen::Matrix<double, 3, 4> turnsOfQuaternion(const double* values)
{
  Eigen::Matrix<double, 3, 4> turns = Eigen::Matrix<double, 3, 4>::Zero();
  Eigen::Vector4d q = Eigen::Map<const Eigen::Vector4d>(values);
  // Divides by the largest value first, as the kinematics do.
  const double largest = q.cwiseAbs().maxCoeff();
  if (largest == 0.0)
    return turns;
  q /= largest;
  const double factor = 2.0 / (q.squaredNorm() * largest);
  for (int k = 0; k < 3; ++k)
    turns.col(k) = factor * (q.w() * Vector3d::Unit(k) - Vector3d::Unit(k).cross(q.head<3>()));
  turns.col(3) = -factor * q.head<3>();
  return turns;
}
}  // namespace

void addPointRates(const RobotModel& robot, const double* state, const Isometry3d* link_poses, int link,
                   const Vector3d& point, const Vector3d& direction, double factor, double* rates)
{
  for (int number = robot.links()[static_cast<std::size_t>(link)].parent_joint; number >= 0;)
  {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(number)];
    const Isometry3d& child = link_poses[joint.child_link];
    const Isometry3d parent = joint.parent_link < 0 ? Isometry3d::Identity() : link_poses[joint.parent_link];
    const Eigen::Matrix3d frame = parent.linear() * joint.origin.linear();
    const auto shift = [&](const Vector3d& axis) { return factor * direction.dot(axis); };
    const auto turn = [&](const Vector3d& axis)
    { return factor * direction.dot(axis.cross(point - child.translation())); };
    double* of_joint = rates + std::max(0, joint.first_variable);  // a fixed joint has none
    switch (joint.type)
    {
      case JointType::Revolute:
      case JointType::Continuous:
        *of_joint += joint.multiplier * turn(child.linear() * joint.axis);
        break;
      case JointType::Prismatic:
        *of_joint += joint.multiplier * shift(frame * joint.axis);
        break;
      case JointType::Planar:
        for (int k = 0; k < 2; ++k)
          of_joint[k] += shift(frame * planarDirections(joint.axis).col(k));
        of_joint[2] += turn(child.linear() * joint.axis);
        break;
      case JointType::Floating:
      {
        const Eigen::Matrix<double, 3, 4> turns = turnsOfQuaternion(state + joint.first_variable + 3);
        for (int k = 0; k < 3; ++k)
          of_joint[k] += shift(frame.col(k));
        for (int k = 0; k < 4; ++k)
          of_joint[3 + k] += turn(frame * turns.col(k));
        break;
      }
      case JointType::Fixed:
        break;
    }
    number = joint.parent_link < 0 ? -1 : robot.links()[static_cast<std::size_t>(joint.parent_link)].parent_joint;
  }
}
}  // namespace gpu_planning_scene::core
