#include "planning/space/valid_row.h"

#include <cmath>
#include <cstddef>

#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"
#include "model/joint_limits.h"
#include "planning/space/waypoints.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Refuses angles of very many turns, because doubles resolve them too coarsely. The state space wraps them to one
/// turn.
void refuseManyTurns(const RobotModel& robot, const std::vector<double>& row, const std::string& what)
{
  for (const Joint& joint : robot.joints())
  {
    const int angle = joint.mimic ? -1 : wrappedAngle(joint);
    if (angle >= 0 && std::abs(row[static_cast<std::size_t>(angle)]) > kLargestProvenAngle)
      throw Error(what + ": " + robot.variables()[static_cast<std::size_t>(angle)].name + " is " +
                  numberText(row[static_cast<std::size_t>(angle)]) + " rad; it must be from -1e6 to 1e6");
  }
}
}  // namespace

void validateRow(const RobotModel& robot, const std::vector<double>& row, const std::string& what)
{
  if (row.size() != robot.variables().size())
    throw Error(what + " has " + std::to_string(row.size()) + " values; the robot has " +
                std::to_string(robot.variables().size()) + " variables");
  for (std::size_t i = 0; i < row.size(); ++i)
    if (!std::isfinite(row[i]))
      throw Error(what + ": " + robot.variables()[i].name + " is " + std::to_string(row[i]) + "; it must be finite");
  refuseManyTurns(robot, row, what);
}
}  // namespace gpu_planning_scene::core
