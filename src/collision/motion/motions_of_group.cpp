#include "collision/motion/motions_of_group.h"

#include <vector>

#include "gpu_planning_scene/error.h"
#include "model/full_states.h"

namespace gpu_planning_scene::core
{
void requireMotionsOfGroup(const RobotModel& robot, const std::string& group, const double* starts, const double* ends,
                           std::size_t count, const std::string& what)
{
  if (group.empty())
    return;
  const std::size_t width = robot.variables().size();
  const std::vector<int>& variables = robot.group(group).variables;
  for (std::size_t i = 0; i < count; ++i)
    if (const int moved = movedVariableBeyond(robot, variables, starts + i * width, ends + i * width); moved >= 0)
      throw Error(
          what + " " + std::to_string(i) + " moves " + robot.variables()[static_cast<std::size_t>(moved)].name +
          ", which is not in group '" + group +
          "', so collisions of the links that it moves would not be found; check without a group, or with one " +
          "that has this joint");
}
}  // namespace gpu_planning_scene::core
