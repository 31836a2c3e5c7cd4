#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "collision/bounds/displacement_bounds.h"
#include "collision/problem/collision_problem.h"
#include "collision/problem/state_range.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// The states of a batch as devices read them. Immutable.
class DeviceRows
{
 public:
  /// `states`: `count` rows of `width` values. `suits_devices`: whether devices can check a state; called on several
  /// threads.
  DeviceRows(const double* states, std::size_t count, std::size_t width,
             std::function<bool(std::size_t row)> suits_devices);

  /// Copies states. In the place of a state that only cores can check, it writes another one, or zeros.
  void copy(const StateRange& states, double* to) const;
  /// Writes zeros instead. Does not read the states.
  void zero(const StateRange& states, double* to) const;

  /// Whether devices can check a state. If not, the answer of a device counts for nothing.
  bool suits(std::size_t row) const { return suits_devices_(row); }
  /// False only if devices can check none of some states of the batch.
  bool suitSomewhere() const;

 private:
  const double* states_;
  std::size_t count_;
  std::size_t width_;
  std::function<bool(std::size_t row)> suits_devices_;
};

/// Only cores can check a state for which the problem is not valid, or which devices cannot place. With margins, states
/// outside the joints' limits have no displacement bounds, and the cores report them as not free. The result refers to
/// the states and the margins.
std::unique_ptr<const DeviceRows> rowsForDevices(const StateBatch& asked, const Margins* margins,
                                                 const RobotModel& robot,
                                                 std::shared_ptr<const CollisionProblem> problem);
}  // namespace gpu_planning_scene::core
