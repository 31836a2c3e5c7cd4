#include "node/messages/trajectory_messages.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The values of the group's variables in a full row.
std::vector<double> valuesOf(const std::vector<double>& row, const Group& group)
{
  std::vector<double> values;
  for (const int variable : group.variables)
    values.push_back(row[static_cast<std::size_t>(variable)]);
  return values;
}
}  // namespace

trajectory_msgs::JointTrajectory trajectoryOf(const RobotModel& robot, const Group& group,
                                              const std::vector<std::vector<double>>& rows, const TimedPath* timed)
{
  trajectory_msgs::JointTrajectory trajectory;
  trajectory.header.frame_id = robot.planningFrame();
  for (const int variable : group.variables)
    trajectory.joint_names.push_back(robot.variables()[static_cast<std::size_t>(variable)].name);
  const auto add = [&](const std::vector<double>& row) -> trajectory_msgs::JointTrajectoryPoint&
  {
    trajectory.points.emplace_back().positions = valuesOf(row, group);
    return trajectory.points.back();
  };
  if (timed == nullptr)
    for (const std::vector<double>& row : rows)
      add(row);
  else
    for (const TimedPoint& timed_point : timed->points)
    {
      trajectory_msgs::JointTrajectoryPoint& point = add(timed_point.positions);
      point.velocities = valuesOf(timed_point.velocities, group);
      point.accelerations = valuesOf(timed_point.accelerations, group);
      point.time_from_start = ros::Duration(timed_point.seconds);
    }
  return trajectory;
}
}  // namespace gpu_planning_scene::core
