#pragma once

#include <optional>

#include "gpu_planning_scene/robot_model.h"

namespace urdf
{
class Joint;
}

namespace gpu_planning_scene::core
{
/// The speed of a joint's <limit>, in rad/s or m/s. No value: it has none. MoveIt reads the speed 0 as no limit.
std::optional<double> velocityLimit(const urdf::Joint& joint);

/// Sets the limits of velocity and acceleration that the entry has. Throws Error if one is not finite or not above 0.
void setVelocityLimits(const JointLimits& limits, Variable& variable);
}  // namespace gpu_planning_scene::core
