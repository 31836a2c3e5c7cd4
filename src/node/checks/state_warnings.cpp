#include "node/checks/state_warnings.h"

#include <utility>

#include "model/joint_limits.h"

namespace gpu_planning_scene::core
{
void addStateWarnings(const Snapshot& now, const std::string& group, const RequestedState& requested,
                      const std::string& what, std::vector<std::string>& warnings)
{
  const RobotModel& robot = *now.scene->robot;
  if (std::string base = now.assumedBase(requested.columns); !base.empty())
    warnings.push_back(std::move(base));
  if (const std::string outside = otherValueOutsideLimits(robot, robot.group(group).variables, requested.state.data());
      !outside.empty())
    warnings.push_back(what + ": " + outside);
  if (const auto turned = findManyTurns(robot, requested.columns, requested.row.values.data(), 1);
      turned && !requested.columns.empty())
    warnings.push_back(what + ": " + turned->text);
}
}  // namespace gpu_planning_scene::core
