#pragma once

#include <vector>

#include <trajectory_msgs/JointTrajectory.h>

#include "gpu_planning_scene/planning/path_timing.h"
#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A path as a trajectory of the group's variables. `rows`: of all variables of the robot, for waypoints without times.
/// `timed`: instead of the rows; null: there are no times.
trajectory_msgs::JointTrajectory trajectoryOf(const RobotModel& robot, const Group& group,
                                              const std::vector<std::vector<double>>& rows, const TimedPath* timed);
}  // namespace gpu_planning_scene::core
