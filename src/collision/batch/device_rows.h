#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "collision/bounds/displacement_bounds.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// The states of a batch as devices read them.
struct DeviceRows
{
  std::shared_ptr<const void> owner;  ///< keeps the states alive: a device that hangs may read them after the call
  const double* states = nullptr;
  /// One per state; 1: only cores can check it, so devices read another state in its place. Empty: devices can check
  /// all states.
  std::vector<std::uint8_t> only_cores = {};
};

/// Only cores can check a state for which the problem is not valid, or which devices cannot place. With margins, states
/// outside the joints' limits have no displacement bounds, and the cores report them as not free. `states` is null if
/// devices can check no state.
DeviceRows rowsForDevices(const StateBatch& asked, const Margins* margins, const RobotModel& robot,
                          const CollisionProblem& problem);
}  // namespace gpu_planning_scene::core
