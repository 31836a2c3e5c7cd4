#include "planning/scene_space.h"

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene
{
std::shared_ptr<const GroupStateSpace> groupSpaceOf(const ompl::base::SpaceInformation& information,
                                                    const PlanningScene& scene)
{
  auto space = std::dynamic_pointer_cast<const GroupStateSpace>(information.getStateSpace());
  if (!space)
    throw Error("the state space '" + information.getStateSpace()->getName() + "' is none of a planning group; use a " +
                "GroupStateSpace");
  if (space->robot() != scene.robot)
    throw Error("the state space '" + space->getName() + "' is not of the scene's robot; make it with the robot of " +
                "the scene, which is another one once its links are scaled");
  return space;
}

std::vector<double> referenceState(const PlanningScene& scene)
{
  return scene.current_state.empty() ? scene.robot->defaultState() : scene.current_state;
}
}  // namespace gpu_planning_scene
