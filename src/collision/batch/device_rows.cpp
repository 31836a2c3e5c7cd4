#include "collision/batch/device_rows.h"

#include <algorithm>
#include <utility>

#include "collision/gpu/problem/placeable_states.h"

namespace gpu_planning_scene::core
{
DeviceRows::DeviceRows(const double* states, std::size_t count, std::size_t width,
                       std::function<bool(std::size_t row)> suits_devices)
  : states_(states), count_(count), width_(width), suits_devices_(std::move(suits_devices))
{
}

void DeviceRows::copy(const StateRange& states, double* to) const
{
  const double* substitute = nullptr;
  for (std::size_t row = states.begin; row < states.end(); ++row, to += width_)
  {
    if (suits(row))
      substitute = states_ + row * width_;
    if (substitute)
      std::copy_n(substitute, width_, to);
    else
      std::fill_n(to, width_, 0.0);
  }
}

void DeviceRows::zero(const StateRange& states, double* to) const
{
  std::fill_n(to, states.count * width_, 0.0);
}

bool DeviceRows::suitSomewhere() const
{
  constexpr std::size_t kSamples = 64;
  for (std::size_t row = 0; row < count_; row += 1 + count_ / kSamples)
    if (suits(row))
      return true;
  return false;
}

std::unique_ptr<const DeviceRows> rowsForDevices(const StateBatch& asked, const Margins* margins,
                                                 const RobotModel& robot,
                                                 std::shared_ptr<const CollisionProblem> problem)
{
  const std::size_t width = robot.variables().size();
  const auto suits_devices = [states = asked.states, width, margins, problem = std::move(problem),
                              placeable = PlaceableStates(robot)](std::size_t row)
  {
    const double* const state = states + row * width;
    return (margins ? margins->within[row] != 0 : isValidFor(*problem, state)) && placeable.contains(state);
  };
  return std::make_unique<const DeviceRows>(asked.states, asked.count, width, suits_devices);
}
}  // namespace gpu_planning_scene::core
