#include "collision/batch/device_rows.h"

#include <algorithm>
#include <utility>

#include "collision/gpu/problem/placeable_states.h"
#include "collision/problem/rows_without.h"

namespace gpu_planning_scene::core
{
DeviceRows rowsForDevices(const StateBatch& asked, const Margins* margins, const RobotModel& robot,
                          const CollisionProblem& problem)
{
  const std::size_t width = robot.variables().size();
  const PlaceableStates placeable(robot);
  const auto suits_devices = [&](std::size_t row)
  {
    const double* const state = asked.states + row * width;
    return (margins ? margins->within[row] != 0 : isValidFor(problem, state)) && placeable.contains(state);
  };
  const std::vector<std::size_t> unsuitable = rowsWithout(asked.count, suits_devices);
  if (unsuitable.size() == asked.count)
    return {};
  if (unsuitable.empty() && asked.owner)
    return {asked.owner, asked.states};
  const auto copy = std::make_shared<std::vector<double>>(asked.states, asked.states + asked.count * width);
  DeviceRows rows{copy, copy->data()};
  if (unsuitable.empty())
    return rows;
  rows.only_cores.assign(asked.count, 0);
  for (const std::size_t row : unsuitable)
    rows.only_cores[row] = 1;
  const auto substitute = std::find(rows.only_cores.begin(), rows.only_cores.end(), 0) - rows.only_cores.begin();
  for (const std::size_t row : unsuitable)
    std::copy_n(asked.states + static_cast<std::size_t>(substitute) * width, width, copy->data() + row * width);
  return rows;
}
}  // namespace gpu_planning_scene::core
