#include "benchmark/updates.h"

#include "benchmark/statistics.h"
#include "benchmark/truth.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr std::size_t kStates = 128;  // states that are compared after each update
}

Updates::Updates(const TestScene& scene, std::size_t repeats) : states_(scene.randomStates(kStates, 1))
{
  if (scene.scene->objects.empty())
    return;
  Truth truth(scene.scene);
  for (std::size_t i = 0; i <= repeats; ++i)
  {
    auto changed = std::make_shared<PlanningScene>(*scene.scene);
    changed->objects[i % changed->objects.size()].pose.translation().z() += 1e-3 * static_cast<double>(i + 1);
    changed->revision = i + 1;
    truth.setScene(changed);
    updates_.push_back({changed, truth.check(states_.data(), kStates)});
  }
}

Updates::Result Updates::measure(const MethodInfo& info, Method& method) const
{
  Result result;
  const std::size_t width = states_.size() / kStates;
  for (std::size_t i = 0; i < updates_.size(); ++i)
  {
    const Update& update = updates_[i];
    const std::size_t row = i % kStates;
    bool taken = false;
    std::vector<std::uint8_t> answer;
    const double seconds = secondsOf(
        [&]
        {
          taken = method.update(update.scene);
          answer = method.check(&states_[row * width], 1);
        });
    if (!taken)
      return {};
    if (i > 0)
      result.seconds.push_back(seconds);
    result.wrong += wrongAnswers(info, answer, update.truth, row);
    result.wrong += wrongAnswers(info, method.check(states_.data(), kStates), update.truth);
  }
  return result;
}
}  // namespace gpu_planning_scene::core::benchmark
