#pragma once

#include <optional>

#include "gpu_planning_scene/planning/path_timing.h"

namespace gpu_planning_scene::core
{
/// How to compute the times of the path of a request (PlanMotion or ComputeCartesianPath); no value if the request
/// wants none. `max_deviation`, `motions`, `path_constraints`: see PathTimingOptions. Throws Error for a scaling factor
/// that is neither 0 nor within its range, and for a group without times.
template <class Request>
std::optional<PathTimingOptions> requestedTiming(const Request& request, const RobotModel& robot, double max_deviation,
                                                 const MotionCheckerOptions& motions,
                                                 const KinematicConstraints& path_constraints)
{
  const auto factor = [](double requested) { return requested == 0.0 ? 1.0 : requested; };
  const PathTimingOptions timing{factor(request.max_velocity_scaling_factor),
                                 factor(request.max_acceleration_scaling_factor), max_deviation, motions,
                                 path_constraints};
  validateTiming(timing);
  if (!request.times)
    return std::nullopt;
  requireTimes(robot, request.group);
  return timing;
}
}  // namespace gpu_planning_scene::core
