#include "planning/space/waypoints.h"

#include <cmath>
#include <cstddef>

#include <Eigen/Core>

#include "gpu_planning_scene/interpolation.h"

// Adds whole turns to angles and changes the sign of quaternions, so that each value continues from the previous row.
// Own method: readers of a path may interpolate its numbers, while OMPL interpolates in its state space.
namespace gpu_planning_scene::core
{
namespace
{
using Row = std::vector<double>;

bool isHalfATurn(const RobotModel& robot, const Row& from, const Row& to)
{
  constexpr double kNearly = 1e-6;  // radians: larger than rounding errors
  const std::vector<JointTravel> travel = jointTravel(robot, from.data(), to.data());
  for (std::size_t i = 0; i < travel.size(); ++i)
  {
    const Joint& joint = robot.joints()[i];
    if (!joint.mimic && (wrappedAngle(joint) >= 0 || joint.type == JointType::Floating) &&
        travel[i].angle > EIGEN_PI - kNearly)
      return true;
  }
  return false;
}

/// Changes the angles and quaternions of `row` so that they continue from `from`, the previous row of the result.
/// `last`: the previous row of the path, which is the same state as `from`.
void unwind(const RobotModel& robot, const Row& from, const Row& last, Row& row)
{
  constexpr int kRotation = 3;  // index of the quaternion within a floating joint's variables
  const Row reached = row;
  for (const Joint& joint : robot.joints())
  {
    if (joint.mimic)
      continue;
    if (const int angle = wrappedAngle(joint); angle >= 0)
      row[angle] = from[angle] + shortestAngularDistance(last[angle], reached[angle]);
    if (joint.type != JointType::Floating)
      continue;
    Eigen::Map<Eigen::Vector4d> rotation(&row[joint.first_variable + kRotation]);
    if (rotation.dot(Eigen::Map<const Eigen::Vector4d>(&from[joint.first_variable + kRotation])) < 0.0)
      rotation = -rotation;
  }
}
}  // namespace

int wrappedAngle(const Joint& joint)
{
  switch (joint.type)
  {
    case JointType::Continuous:
      return joint.first_variable;
    case JointType::Planar:
      return joint.first_variable + 2;
    default:
      return -1;
  }
}

void continueAngles(const RobotModel& robot, const Row& from, Row& row)
{
  constexpr double kTurn = 2.0 * EIGEN_PI;
  for (const Joint& joint : robot.joints())
    if (const int angle = joint.mimic ? -1 : wrappedAngle(joint);
        angle >= 0 && (joint.type == JointType::Planar || isPeriodic(robot, joint)))
    {
      double& value = row[static_cast<std::size_t>(angle)];
      const double before = from[static_cast<std::size_t>(angle)];
      value += kTurn * std::round((before + shortestAngularDistance(before, value) - value) / kTurn);
    }
}

std::vector<Row> waypointsOf(const ompl::geometric::PathGeometric& path, const GroupStateSpace& space, const Row& start)
{
  const RobotModel& robot = *space.robot();
  std::vector<Row> rows;
  for (std::size_t i = 0; i < path.getStateCount(); ++i)
  {
    Row row = start;
    space.copyToRow(path.getState(static_cast<unsigned int>(i)), row.data());
    if (!rows.empty() && isHalfATurn(robot, rows.back(), row))
    {
      Row half(row.size());
      interpolate(robot, rows.back().data(), row.data(), 0.5, half.data());
      Row middle = start;
      for (const int variable : space.variables())
        middle[variable] = half[variable];
      rows.push_back(std::move(middle));
    }
    rows.push_back(std::move(row));
  }
  std::vector<Row> waypoints = rows;
  for (std::size_t i = 0; i < rows.size(); ++i)
    unwind(robot, i == 0 ? start : waypoints[i - 1], i == 0 ? start : rows[i - 1], waypoints[i]);
  return waypoints;
}
}  // namespace gpu_planning_scene::core
