#include "node/requested_states.h"

#include <cmath>

#include "gpu_planning_scene/error.h"
#include "tools/full_states.h"

namespace gpu_planning_scene
{
std::vector<double> requestedStates(const std::vector<std::string>& joint_names, const std::vector<double>& values,
                                    const std::string& what, const Snapshot& now)
{
  if (joint_names.empty())
    throw Error("joint_names is empty; name at least one variable");
  const RobotModel& robot = *now.scene->robot;
  const std::vector<int> columns = variableIndices(robot, joint_names);
  const std::size_t width = columns.size();
  if (values.size() % width != 0)
    throw Error(std::to_string(values.size()) + " " + what + " are not rows of " + std::to_string(width) +
                " values, one per joint name");
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw Error("state " + std::to_string(i / width) + ": the position of '" + joint_names[i % width] +
                  "' is not a finite number");
  PartialState current(robot);
  current.values = now.state;
  current.known = now.known;
  return fullStates(robot, columns, values.data(), values.size() / width, current);
}
}  // namespace gpu_planning_scene
