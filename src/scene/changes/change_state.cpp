#include <algorithm>
#include <cmath>

#include "gpu_planning_scene/error.h"
#include "model/joint_limits.h"
#include "scene/changes/scene_changer.h"

// The state of the robot, and its attached objects.
namespace gpu_planning_scene::core
{
void SceneChanger::changeState(const StateChange& change, bool is_full_scene)
{
  setVariables(change.variables);
  if (!change.is_diff && (is_full_scene || !change.variables.empty()))
    removeReplacedAttached(change);
  for (const AttachedChange& attached : change.attached)
  {
    if (!change.is_diff && attached.object.operation != Operation::Add)
      throw Error("object '" + attached.object.id + "': a robot state with is_diff false can only add attached " +
                  "objects; set robot_state.is_diff to true");
    changeAttached(attached);
  }
}

void SceneChanger::setVariables(const std::map<std::string, double>& variables)
{
  const RobotModel& robot = *result_.scene.robot;
  if (variables.empty())
    return;
  const bool is_known = !result_.state.empty() || variables.size() == robot.variables().size();
  std::vector<double> state = result_.state.empty() ? robot.defaultState() : result_.state;
  std::vector<int> columns;
  std::vector<double> values;
  for (const auto& [name, value] : variables)
  {
    const int variable = robot.variableIndex(name);
    if (variable < 0)
      throw Error("robot_state: robot '" + robot.name() + "' has no joint variable '" + name + "'");
    if (!std::isfinite(value))
      throw Error("robot_state: the position of '" + name + "' is not finite");
    state[static_cast<std::size_t>(variable)] = value;
    columns.push_back(variable);
    values.push_back(value);
  }
  if (const auto outside = findValueOutsideLimits(robot, columns, values.data(), 1))
    result_.warnings.push_back("robot_state: " + outside->text);
  // The values of only some joints are not a state. No values are invented for the other joints, so a change that needs
  // the pose of a link is refused.
  if (is_known)
    result_.state = std::move(state);
}

/// As in MoveIt, a robot state whose is_diff is false replaces the attached objects. Clients often leave is_diff unset
/// by mistake, so each object that is removed gives a warning.
void SceneChanger::removeReplacedAttached(const StateChange& change)
{
  for (const std::string& id : attached_.ids())
  {
    const AttachedObject dropped = attached_.take(id);
    count_.remove(dropped.object.shapes);
    const bool comes_back = std::any_of(change.attached.begin(), change.attached.end(),
                                        [&id](const AttachedChange& added) { return added.object.id == id; });
    if (comes_back)
      continue;
    forget(id);
    result_.warnings.push_back("object '" + id + "' was removed from link '" + linkName(dropped.link) +
                               "', because robot_state.is_diff is false: this replaces all attached objects");
  }
}
}  // namespace gpu_planning_scene::core
