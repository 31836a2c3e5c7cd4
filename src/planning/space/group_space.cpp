#include "planning/space/group_space.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
std::shared_ptr<const GroupStateSpace> groupSpaceOf(const ompl::base::SpaceInformation& information,
                                                    const PlanningScene& scene)
{
  auto space = std::dynamic_pointer_cast<const GroupStateSpace>(information.getStateSpace());
  if (!space)
    throw Error("the state space '" + information.getStateSpace()->getName() + "' is not a GroupStateSpace; use a " +
                "GroupStateSpace");
  if (space->robot() != scene.robot)
    throw Error("the state space '" + space->getName() + "' is for another robot; make it with the scene's robot " +
                "(scaling links replaces that robot)");
  return space;
}

void requireHolonomic(const RobotModel& robot, const Group& group)
{
  for (const int index : group.joints)
    if (const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
        joint.diff_drive && !joint.mimic && !joint.passive)
      throw Error("joint '" + joint.name + "' of group '" + group.name + "' cannot be planned for: it drives only " +
                  "along its heading (motion_model diff_drive in the SRDF), and planned motions would drive sideways");
}

std::vector<double> referenceState(const PlanningScene& scene)
{
  return scene.current_state.empty() ? scene.robot->defaultState() : scene.current_state;
}

bool isWithin(const GroupStateSpace& space, const ompl::base::State* state)
{
  const std::vector<ompl::base::StateSpace::ValueLocation>& locations = space.getValueLocations();
  return std::all_of(locations.begin(), locations.end(),
                     [&](const auto& location)
                     { return std::isfinite(*space.getValueAddressAtLocation(state, location)); }) &&
         space.satisfiesBounds(state);
}

void appendRow(const GroupStateSpace& space, const std::vector<double>& reference, const ompl::base::State* state,
               std::vector<double>& rows)
{
  const std::size_t begin = rows.size();
  rows.insert(rows.end(), reference.begin(), reference.end());
  space.copyToRow(state, &rows[begin]);
}
}  // namespace gpu_planning_scene::core
