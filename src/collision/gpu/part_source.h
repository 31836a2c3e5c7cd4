#pragma once

#include <cstddef>
#include <cstdint>

#include "collision/problem/state_range.h"
#include "gpu_planning_scene/batch_checker_options.h"

namespace gpu_planning_scene::core
{
/// Where a device gets the states of a batch from, and where it brings their verdicts. Used on the context's thread.
class PartSource
{
 public:
  virtual ~PartSource() = default;

  /// The next states, at most `most`. An empty range: there is none, and the device need not ask again.
  virtual StateRange take(std::size_t most) = 0;

  /// Copies the values of states that were taken: rows of the robot's variables. Called on several threads at once.
  virtual void copy(const StateRange& states, double* to) = 0;

  /// The verdicts of states that were taken, see GpuPairChecker, and the work for them. The states of a part may come
  /// in several calls, in ascending order.
  virtual void bring(const StateRange& states, const std::uint32_t* verdicts, const GpuWork& work) = 0;
};
}  // namespace gpu_planning_scene::core
