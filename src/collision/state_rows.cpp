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

void refuseNonFinite(const RobotModel& robot, const double* states, std::size_t count)
{
  const auto& variables = robot.variables();
  for (std::size_t i = 0; i < count * variables.size(); ++i)
    if (!std::isfinite(states[i]))
      throw Error("state " + std::to_string(i / variables.size()) + ": the value of variable '" +
                  variables[i % variables.size()].name + "' is not a finite number");
}
}  // namespace gpu_planning_scene
