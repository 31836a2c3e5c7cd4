#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "collision/bounds/displacement_bounds.h"
#include "collision/problem/collision_problem.h"
#include "collision/problem/state_range.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
/// The states of a batch as devices read them. The functions may run at the same time, `copy` for different states.
class DeviceRows
{
 public:
  /// `states`: rows of `width` values. `suits_devices`: whether devices can check a state; called on several threads.
  DeviceRows(const double* states, std::size_t count, std::size_t width,
             std::function<bool(std::size_t row)> suits_devices);

  /// Copies states. In the place of a state that only cores can check, it writes another one, or zeros.
  void copy(const StateRange& states, double* to);

  /// Whether only cores can check a state that was copied. Its answer by a device counts for nothing.
  bool isOnlyForCores(std::size_t row) const { return only_cores_[row] != 0; }
  /// False: devices can check all states that were copied.
  bool haveOnlyForCores() const { return have_only_for_cores_; }

 private:
  const double* states_;
  std::size_t width_;
  std::function<bool(std::size_t row)> suits_devices_;
  std::vector<std::uint8_t> only_cores_;
  std::atomic<bool> have_only_for_cores_{false};
};

/// Only cores can check a state for which the problem is not valid, or which devices cannot place. With margins, states
/// outside the joints' limits have no displacement bounds, and the cores report them as not free. The result refers to
/// the states and the margins.
std::unique_ptr<DeviceRows> rowsForDevices(const StateBatch& asked, const Margins* margins, const RobotModel& robot,
                                           std::shared_ptr<const CollisionProblem> problem);
}  // namespace gpu_planning_scene::core
