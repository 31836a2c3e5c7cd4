#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// The starts and ends of a request's motions.
struct RequestedEnds
{
  std::vector<int> columns;    ///< the variables that the request sets
  std::vector<double> starts;  ///< row-major: one row of values for `columns` per motion
  std::vector<double> ends;    ///< the same
  std::size_t count = 0;       ///< of motions
};

/// Reads the starts and ends, which can be states that the SRDF names. `require_count` throws Error for too many
/// motions. Throws Error for values that requestedColumns refuses, different numbers of starts and ends, an unknown
/// name, and a name together with values.
RequestedEnds requestedEnds(const RobotModel& robot, const CheckMotions::Request& request,
                            const std::function<void(std::size_t)>& require_count);
}  // namespace gpu_planning_scene::core
