#pragma once

#include <cstddef>
#include <vector>

#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// The waypoints of a request's trajectory.
struct RequestedTrajectory
{
  std::vector<int> columns;  ///< the variables that the trajectory sets
  std::vector<double> rows;  ///< row-major: one row of values for `columns` per waypoint
  std::size_t waypoints = 0;
};

/// Reads both trajectories of a request. Throws Error that names the joint or the waypoint: for no waypoint, numbers
/// of points or times that differ between the two trajectories, joints that the robot does not have or that have no
/// value of their own, joints that are given twice, wrong numbers of values, and values that are not finite.
RequestedTrajectory requestedTrajectory(const RobotModel& robot, const trajectory_msgs::JointTrajectory& joints,
                                        const trajectory_msgs::MultiDOFJointTrajectory& transforms);
}  // namespace gpu_planning_scene::core
