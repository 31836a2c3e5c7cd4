#include "planning/scene_space.h"

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene
{
std::shared_ptr<const GroupStateSpace> groupSpaceOf(const ompl::base::SpaceInformation& information,
                                                    const PlanningScene& scene)
{
  auto space = std::dynamic_pointer_cast<const GroupStateSpace>(information.getStateSpace());
  if (!space)
    throw Error("the state space '" + information.getStateSpace()->getName() +
                "' is no GroupStateSpace; make the space information with one");
  if (space->robot() != scene.robot)
    throw Error("the state space of group '" + space->group().name + "' is of another robot model than the scene's");
  return space;
}

std::vector<double> referenceState(const PlanningScene& scene)
{
  return scene.current_state.empty() ? scene.robot->defaultState() : scene.current_state;
}
}  // namespace gpu_planning_scene
