#pragma once

#include <memory>

#include "gpu_planning_scene/robot_model.h"

namespace gpu_planning_scene::core
{
/// A chain of one joint of each type with tilted frames: a floating base, then a continuous, a revolute, a prismatic, a
/// mimic, a planar and a floating joint. The group `all` is the whole chain, from the base to the link `end`. `middle`
/// is the child link of the mimic joint.
std::shared_ptr<const RobotModel> allJointsRobot();
}  // namespace gpu_planning_scene::core
