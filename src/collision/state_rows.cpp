#include "collision/state_rows.h"

#include <cmath>
#include <string>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene
{
void refuseMissingRobot(const std::shared_ptr<const PlanningScene>& scene)
{
  if (!scene || !scene->robot)
  {
    throw Error("there is no planning scene, or it has no robot");
  }
}

void refuseUnfitting(const RobotModel& robot, const Surroundings& around, std::size_t count)
{
  const std::size_t joints = robot.joints().size();
  const std::size_t rows = joints == 0 ? 0 : around.ways.size() / joints;
  if (around.rows.size() != count || rows * joints != around.ways.size())
    throw Error("what is around " + std::to_string(count) + " states of " + std::to_string(joints) +
                " joints is given for " + std::to_string(around.rows.size()) + " states and by " +
                std::to_string(around.ways.size()) + " ways");
  for (std::size_t i = 0; i < count; ++i)
    if (around.rows[i] >= rows)
      throw Error("what is around state " + std::to_string(i) + " is row " + std::to_string(around.rows[i]) + " of " +
                  std::to_string(rows));
  for (const JointWay& way : around.ways)
    if (!(way.length >= 0.0 && way.angle >= 0.0 && std::isfinite(way.length) && std::isfinite(way.angle)))
      throw Error("a joint's way around a state is " + std::to_string(way.length) + " m and " +
                  std::to_string(way.angle) + " rad; both must be finite and at least 0");
}

void refuseNonFinite(const RobotModel& robot, const double* states, std::size_t count)
{
  const auto& variables = robot.variables();
  for (std::size_t i = 0; i < count * variables.size(); ++i)
    if (!std::isfinite(states[i]))
      throw Error("state " + std::to_string(i / variables.size()) + ": the value of variable '" +
                  variables[i % variables.size()].name + "' is not a finite number");
}
}  // namespace gpu_planning_scene
