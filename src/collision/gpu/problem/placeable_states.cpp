#include "collision/gpu/problem/placeable_states.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gpu_planning_scene::core
{
namespace
{
constexpr double kLargestShaderAngle = 1048576.0;  // 2^20, see shaders/problem/kinematics.glsl

// A device may replace denormal doubles by 0, also the reciprocal of a very large number.
constexpr double kLargestQuaternion = 1e150;
}  // namespace

PlaceableStates::PlaceableStates(const RobotModel& robot)
  : largest_(robot.variables().size(), std::numeric_limits<double>::max())
{
  for (const Joint& joint : robot.joints())
  {
    if (joint.first_variable < 0)
      continue;
    const auto first = static_cast<std::size_t>(joint.first_variable);
    if (joint.type == JointType::Floating)
      quaternions_.push_back(first + 3);
    const bool turns = joint.type == JointType::Revolute || joint.type == JointType::Continuous;
    const bool planar = joint.type == JointType::Planar;
    if (!turns && !planar)
      continue;
    double& least = largest_[first + (planar ? 2U : 0U)];
    const double multiplier = planar ? 1.0 : std::max(std::abs(joint.multiplier), 1e-300);
    const double offset = planar ? 0.0 : std::abs(joint.offset);
    least = std::min(least, (kLargestShaderAngle - offset) / multiplier * (1.0 - 1e-9));
  }
}

bool PlaceableStates::contains(const double* state) const
{
  bool within = true;
  for (std::size_t i = 0; i < largest_.size(); ++i)
    within &= std::abs(state[i]) <= largest_[i];
  if (!within)
    return false;
  return std::all_of(quaternions_.begin(), quaternions_.end(),
                     [state](std::size_t first)
                     {
                       double largest = 0.0;
                       for (std::size_t i = first; i < first + 4; ++i)
                         largest = std::max(largest, std::abs(state[i]));
                       return largest == 0.0 || (largest >= 1.0 / kLargestQuaternion && largest <= kLargestQuaternion);
                     });
}
}  // namespace gpu_planning_scene::core
