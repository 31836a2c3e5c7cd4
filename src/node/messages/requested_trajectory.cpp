#include "node/messages/requested_trajectory.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "model/full_states.h"
#include "node/messages/joint_transform.h"

namespace gpu_planning_scene::core
{
namespace
{
using Points = trajectory_msgs::JointTrajectory::_points_type;
using MultiDofPoints = trajectory_msgs::MultiDOFJointTrajectory::_points_type;

std::string waypointText(const char* field, std::size_t waypoint)
{
  return std::string(field) + ": waypoint " + std::to_string(waypoint);
}

/// Throws Error unless the names and the points of a trajectory are both empty or both not empty.
void requireBoth(const char* field, std::size_t names, std::size_t points)
{
  if ((names == 0) != (points == 0))
    throw Error(std::string(field) + " has " + std::to_string(names) + " joints and " + std::to_string(points) +
                " points; give both, or leave both empty");
}

void requireValues(const char* field, std::size_t waypoint, std::size_t values, std::size_t joints)
{
  if (values != joints)
    throw Error(waypointText(field, waypoint) + " has " + std::to_string(values) + " values for " +
                std::to_string(joints) + " joints");
}

/// The two trajectories describe the same waypoints. A trajectory without times has only zeros.
void requireEqualTimes(const Points& joints, const MultiDofPoints& transforms)
{
  if (joints.size() != transforms.size())
    throw Error("joint_trajectory has " + std::to_string(joints.size()) +
                " points and multi_dof_joint_trajectory has " + std::to_string(transforms.size()) +
                "; give the same number, or leave one of the two empty");
  if (joints.back().time_from_start.isZero() || transforms.back().time_from_start.isZero())
    return;
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i].time_from_start != transforms[i].time_from_start)
      throw Error("waypoint " + std::to_string(i) + " is at " + std::to_string(joints[i].time_from_start.toSec()) +
                  " s in joint_trajectory and at " + std::to_string(transforms[i].time_from_start.toSec()) +
                  " s in multi_dof_joint_trajectory; give points of the same times");
}

const Joint& multiDofJoint(const RobotModel& robot, const std::string& name)
{
  const int index = robot.jointIndex(name);
  if (index >= 0 && variableCount(robot.joints()[static_cast<std::size_t>(index)].type) > 1)
    return robot.joints()[static_cast<std::size_t>(index)];
  std::vector<std::string> known;
  for (const Joint& joint : robot.joints())
    if (variableCount(joint.type) > 1)
      known.push_back(joint.name);
  const std::string reason =
      index < 0 ? "is not a joint of the robot" : "is neither planar nor floating; name it in joint_trajectory";
  throw Error("multi_dof_joint_trajectory: '" + name + "' " + reason +
              "; the robot's planar and floating joints are: " + (known.empty() ? "none" : nameList(known)));
}
}  // namespace

RequestedTrajectory requestedTrajectory(const RobotModel& robot, const trajectory_msgs::JointTrajectory& joints,
                                        const trajectory_msgs::MultiDOFJointTrajectory& transforms)
{
  constexpr const char* kJoints = "joint_trajectory";
  constexpr const char* kMultiDof = "multi_dof_joint_trajectory";
  requireBoth(kJoints, joints.joint_names.size(), joints.points.size());
  requireBoth(kMultiDof, transforms.joint_names.size(), transforms.points.size());
  if (joints.points.empty() && transforms.points.empty())
    throw Error("the trajectory has no waypoints; give joint_trajectory, multi_dof_joint_trajectory, or both");
  if (!joints.points.empty() && !transforms.points.empty())
    requireEqualTimes(joints.points, transforms.points);

  std::vector<std::string> names = joints.joint_names;
  std::vector<const Joint*> multi_dof;
  for (const std::string& name : transforms.joint_names)
  {
    const Joint& joint = multiDofJoint(robot, name);
    multi_dof.push_back(&joint);
    for (int i = 0; i < variableCount(joint.type); ++i)
      names.push_back(robot.variables()[static_cast<std::size_t>(joint.first_variable + i)].name);
  }
  RequestedTrajectory trajectory;
  trajectory.columns = variableIndices(robot, names);
  trajectory.waypoints = std::max(joints.points.size(), transforms.points.size());
  trajectory.rows.reserve(trajectory.waypoints * names.size());
  for (std::size_t i = 0; i < trajectory.waypoints; ++i)
  {
    if (!joints.points.empty())
    {
      const std::vector<double>& positions = joints.points[i].positions;
      requireValues(kJoints, i, positions.size(), joints.joint_names.size());
      for (std::size_t j = 0; j < positions.size(); ++j)
        if (!std::isfinite(positions[j]))
          throw Error(waypointText(kJoints, i) + ": the position of '" + joints.joint_names[j] +
                      "' is not a finite number");
      trajectory.rows.insert(trajectory.rows.end(), positions.begin(), positions.end());
    }
    if (!transforms.points.empty())
    {
      requireValues(kMultiDof, i, transforms.points[i].transforms.size(), multi_dof.size());
      for (std::size_t j = 0; j < multi_dof.size(); ++j)
      {
        const std::string where = waypointText(kMultiDof, i) + ": '" + multi_dof[j]->name + "'";
        const std::vector<double> values = variablesOfTransform(robot, *multi_dof[j], transforms.header.frame_id,
                                                                transforms.points[i].transforms[j], where);
        trajectory.rows.insert(trajectory.rows.end(), values.begin(), values.end());
      }
    }
  }
  return trajectory;
}
}  // namespace gpu_planning_scene::core
