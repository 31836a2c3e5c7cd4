#include "benchmark/updates.h"

#include <limits>

#include "benchmark/statistics.h"

namespace gpu_planning_scene::benchmark
{
double secondsOfUpdate(Method& method, const TestScene& scene, std::size_t repeats)
{
  if (scene.scene->objects.empty())
    return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> state = scene.randomStates(1, 1);
  std::vector<double> times;
  for (std::size_t i = 0; i <= repeats; ++i)
  {
    auto changed = std::make_shared<PlanningScene>(*scene.scene);
    changed->objects[i % changed->objects.size()].pose.translation().z() += 1e-3 * static_cast<double>(i + 1);
    changed->revision = i + 1;
    bool taken = false;
    const double seconds = secondsOf(
        [&]
        {
          taken = method.update(changed);
          method.check(state.data(), 1);
        });
    if (!taken)
      return std::numeric_limits<double>::quiet_NaN();
    if (i > 0)
      times.push_back(seconds);
  }
  return median(times);
}
}  // namespace gpu_planning_scene::benchmark
