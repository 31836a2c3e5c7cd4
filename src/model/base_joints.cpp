#include "model/base_joints.h"

#include <algorithm>

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

void keepBase(const RobotModel& robot, const double* from, double* state)
{
  for (const Joint& joint : robot.joints())
    if (joint.type == JointType::Planar || joint.type == JointType::Floating)
      std::copy_n(from + joint.first_variable, variableCount(joint.type), state + joint.first_variable);
}
}  // namespace gpu_planning_scene::core
