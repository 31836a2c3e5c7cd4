#pragma once

#include <Eigen/Geometry>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// Adds to `rates` how fast a point of a link moves along a direction while each variable of the state changes: one
/// value per variable, in metres per unit of the variable, times `factor`. `point` and `direction` are in the planning
/// frame; `link_poses` are those of the state. For the quaternion of a floating joint, these are the derivatives by its
/// four values before it is normalised; 0 for a quaternion of zero length. Thread-safe. K. M. Lynch, F. C. Park: Modern
/// Robotics, 2017, chapter 5.
void addPointRates(const RobotModel& robot, const double* state, const Eigen::Isometry3d* link_poses, int link,
                   const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double factor, double* rates);
}  // namespace gpu_planning_scene::core
