#include "model/description/velocity_limits.h"

#include <cmath>
#include <limits>

#include <urdf_model/model.h>

#include "base/text/number_text.h"
#include "gpu_planning_scene/error.h"

// The limits of velocity and acceleration are those that MoveIt's RobotModel and RobotModelLoader give a joint, except
// that a limit of joint_limits must be above 0. MoveIt refuses other limits only when it computes times.
namespace gpu_planning_scene::core
{
namespace
{
void require(const JointLimits& limits, const std::optional<double>& limit, const char* key, const char* flag)
{
  if (limit && !(std::isfinite(*limit) && *limit > 0.0))
    throw Error(limits.source + ": '" + limits.variable + "' has the " + key + " " + numberText(*limit) +
                "; it must be finite and above 0 (for no limit, set " + flag + ": false)");
}
}  // namespace

std::optional<double> velocityLimit(const urdf::Joint& joint)
{
  if (!joint.limits || !std::isfinite(joint.limits->velocity) ||
      !(joint.limits->velocity > std::numeric_limits<double>::epsilon()))
    return std::nullopt;
  return joint.limits->velocity;
}

void setVelocityLimits(const JointLimits& limits, Variable& variable)
{
  require(limits, limits.max_velocity, "max_velocity", "has_velocity_limits");
  require(limits, limits.max_acceleration, "max_acceleration", "has_acceleration_limits");
  if (limits.max_velocity || limits.drops_velocity_limit)
    variable.max_velocity = limits.max_velocity;
  if (limits.max_acceleration)
    variable.max_acceleration = limits.max_acceleration;
}
}  // namespace gpu_planning_scene::core
