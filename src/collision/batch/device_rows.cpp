#include "collision/batch/device_rows.h"

#include <algorithm>
#include <utility>

#include "collision/gpu/problem/placeable_states.h"

namespace gpu_planning_scene::core
{
DeviceRows::DeviceRows(const double* states, std::size_t count, std::size_t width,
                       std::function<bool(std::size_t row)> suits_devices)
  : states_(states), width_(width), suits_devices_(std::move(suits_devices)), only_cores_(count, 0)
{
}

void DeviceRows::copy(const StateRange& states, double* to)
{
  const double* substitute = nullptr;
  for (std::size_t row = states.begin; row < states.end(); ++row, to += width_)
  {
    const bool suits = suits_devices_(row);
    if (suits)
      substitute = states_ + row * width_;
    else
    {
      only_cores_[row] = 1;
      have_only_for_cores_ = true;
    }
    if (substitute)
      std::copy_n(substitute, width_, to);
    else
      std::fill_n(to, width_, 0.0);
  }
}

std::unique_ptr<DeviceRows> rowsForDevices(const StateBatch& asked, const Margins* margins, const RobotModel& robot,
                                           std::shared_ptr<const CollisionProblem> problem)
{
  const std::size_t width = robot.variables().size();
  const auto suits_devices = [states = asked.states, width, margins, problem = std::move(problem),
                              placeable = PlaceableStates(robot)](std::size_t row)
  {
    const double* const state = states + row * width;
    return (margins ? margins->within[row] != 0 : isValidFor(*problem, state)) && placeable.contains(state);
  };
  return std::make_unique<DeviceRows>(asked.states, asked.count, width, suits_devices);
}
}  // namespace gpu_planning_scene::core
