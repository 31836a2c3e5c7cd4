#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "model/description/tree_builder.h"

namespace urdf
{
class Joint;
}

namespace gpu_planning_scene::core
{
/// The variable of a revolute or prismatic joint, with the limits of its <limit> (velocityLimit for the velocity), and
/// of its <safety_controller> where those are narrower. `where`: the joint's place in the URDF, for messages. Throws
/// Error if no position is within the limits.
Variable limitedVariable(const urdf::Joint& joint, const std::string& where, std::vector<std::string>& warnings);

/// Replaces limits of the tree's variables by `limits`, as MoveIt does with its joint_limits.yaml. An entry for a joint
/// that can have no limits, or that the robot does not have, gives a warning. Throws Error for a limit that is not
/// finite, for a velocity or acceleration that is not above 0, and if no position is within the limits.
void applyJointLimits(const std::vector<JointLimits>& limits, RobotTree& tree, std::vector<std::string>& warnings);
}  // namespace gpu_planning_scene::core
