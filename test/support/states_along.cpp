#include "support/states_along.h"

#include <algorithm>

namespace gpu_planning_scene::core
{
std::vector<double> statesAlong(const RobotModel& robot, const std::vector<std::vector<double>>& rows,
                                const MotionSteps& steps)
{
  constexpr double kLeastSteps = 10.0;
  std::vector<double> states;
  for (std::size_t i = 1; i < rows.size(); ++i)
  {
    const double* const from = rows[i - 1].data();
    const double* const to = rows[i].data();
    const double count = std::max(kLeastSteps, segmentCount(robot, from, to, steps));
    for (std::size_t step = 0; step <= static_cast<std::size_t>(count); ++step)
    {
      states.resize(states.size() + rows[i].size());
      interpolate(robot, from, to, static_cast<double>(step) / count, &states[states.size() - rows[i].size()]);
    }
  }
  return states;
}
}  // namespace gpu_planning_scene::core
