#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// Returns the scene without the values of joints that follow other joints. MoveIt's messages list these joints too.
/// The conversion of a message would warn of them each time.
PlanningSceneMessage withoutMimicJoints(PlanningSceneMessage scene, const RobotModel& robot);

/// A text about the first joint whose value in the scene is more than 1e-3 (radians or metres) from the one that the
/// joint that it follows gives it; otherwise empty. MoveIt would check the value of the message. `state`: one value per
/// variable, for joints that the scene does not name.
std::string mimicFault(const PlanningSceneMessage& scene, const RobotModel& robot, const std::vector<double>& state);
}  // namespace gpu_planning_scene::core
