#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gpu_planning_scene/robot_model.h"
#include "model/full_states.h"
#include "node/messages/messages.h"

namespace gpu_planning_scene::core
{
/// The starts and ends of a request's motions.
struct RequestedEnds
{
  std::vector<int> columns;    ///< the variables that the request sets
  std::vector<double> starts;  ///< row-major: one row of values for `columns` per motion
  std::vector<double> ends;    ///< as `starts`
  std::size_t count = 0;       ///< the number of motions
};

/// Reads the starts and ends, which can be states that the SRDF names. A variable that only the end sets starts at its
/// value in `current`. A variable that only the start sets keeps its value. `require_count` throws Error for too many
/// motions. Throws Error for names and values that requestedColumns refuses, different numbers of starts and ends, an
/// unknown name, a name together with values, and a value that `current` does not know.
RequestedEnds requestedEnds(const RobotModel& robot, const CheckMotions::Request& request, const PartialState& current,
                            const std::function<void(std::size_t)>& require_count);
}  // namespace gpu_planning_scene::core
