#include "model/virtual_joint.h"

namespace gpu_planning_scene::core
{
std::vector<int> virtualVariables(const RobotModel& robot)
{
  std::vector<int> variables;
  for (const Joint& joint : robot.joints())
    for (int i = 0; joint.parent_link < 0 && i < variableCount(joint.type); ++i)
      variables.push_back(joint.first_variable + i);
  return variables;
}
}  // namespace gpu_planning_scene::core
