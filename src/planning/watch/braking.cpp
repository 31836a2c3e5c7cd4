#include "planning/watch/braking.h"

#include <algorithm>
#include <limits>

#include "gpu_planning_scene/interpolation.h"

// If the rate of a motion falls evenly from 1 to 0 within T seconds, the motion goes on by T / 2 seconds, and a joint
// with velocity v decelerates by v / T. So T must be at least v / a for the deceleration a of each joint, in each part
// that the robot still passes. Own method.
namespace gpu_planning_scene::core
{
namespace
{
/// The least limit of some variables of a joint; 1 without a limit, as in timePath.
double accelerationOf(const RobotModel& robot, int first, int count)
{
  double least = std::numeric_limits<double>::infinity();
  for (int i = first; i < first + count; ++i)
    least = std::min(least, robot.variables()[static_cast<std::size_t>(i)].max_acceleration.value_or(1.0));
  return least;
}

/// Seconds in which the robot can brake from the velocities of a part that lasts `seconds`. A joint that mimics another
/// one has no limits, as in timePath.
double brakingTime(const RobotModel& robot, const double* from, const double* to, double seconds)
{
  const std::vector<JointTravel> travels = jointTravel(robot, from, to);
  double longest = 0.0;
  for (std::size_t i = 0; i < travels.size(); ++i)
  {
    const Joint& joint = robot.joints()[i];
    const int count = variableCount(joint.type);
    if (joint.mimic || count == 0)
      continue;
    const JointTravel& travel = travels[i];
    const bool moves_freely = joint.type == JointType::Planar || joint.type == JointType::Floating;
    const int lengths = joint.type == JointType::Planar ? 2 : joint.type == JointType::Floating ? 3 : count;
    if (travel.length > 0.0)
      longest = std::max(longest, travel.length / accelerationOf(robot, joint.first_variable, lengths));
    if (travel.angle > 0.0)
      longest =
          std::max(longest, travel.angle / accelerationOf(robot, joint.first_variable + (moves_freely ? lengths : 0),
                                                          moves_freely ? count - lengths : count));
  }
  return longest / seconds;
}
}  // namespace

double latestBraking(const RobotModel& robot, const TimedRows& motion, double until)
{
  const std::size_t width = robot.variables().size();
  // From the part that contains `until` back to the first one: each earlier part that the robot passes while it brakes
  // can only lengthen the braking.
  double longest = 0.0;
  for (std::size_t part = motion.seconds.size() - 1; part-- > 0;)
  {
    const double begin = motion.seconds[part];
    if (begin >= until)
      continue;
    const double* const from = motion.values.data() + part * width;
    longest = std::max(longest, brakingTime(robot, from, from + width, motion.seconds[part + 1] - begin));
    if (const double brake_by = until - 0.5 * longest; brake_by >= begin)
      return brake_by;
  }
  return -std::numeric_limits<double>::infinity();
}
}  // namespace gpu_planning_scene::core
