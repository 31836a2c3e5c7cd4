#pragma once

#include "gpu_planning_scene/robot_model.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// Returns the scene without the values of joints that follow other joints. MoveIt's messages list these joints too.
/// The conversion of a message would warn of them each time.
PlanningSceneMessage withoutMimicJoints(PlanningSceneMessage scene, const RobotModel& robot);
}  // namespace gpu_planning_scene::core
