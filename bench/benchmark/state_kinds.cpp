#include "benchmark/state_kinds.h"

#include "support/near_contact.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr std::size_t kStatesOfAWay = 64;

std::vector<double> motionStates(const TestScene& scene, std::size_t count, std::uint64_t seed)
{
  const std::size_t width = scene.lower.size();
  const std::size_t ways = (count + kStatesOfAWay - 1) / kStatesOfAWay;
  const std::vector<double> ends = scene.randomStates(2 * ways, seed);
  std::vector<double> states;
  states.reserve(count * width);
  for (std::size_t i = 0; i < count; ++i)
  {
    const double* from = &ends[2 * (i / kStatesOfAWay) * width];
    const double position = static_cast<double>(i % kStatesOfAWay) / (kStatesOfAWay - 1);
    for (std::size_t v = 0; v < width; ++v)
      states.push_back(from[v] + position * (from[width + v] - from[v]));
  }
  return states;
}
}  // namespace

const std::vector<std::string>& stateKinds()
{
  static const std::vector<std::string> kinds = {"random", "near_contact", "motion"};
  return kinds;
}

std::vector<double> makeStates(const TestScene& scene, const std::string& kind, std::size_t count, std::uint64_t seed)
{
  if (kind == "near_contact")
    return nearContactStates(scene, count, seed);
  return kind == "motion" ? motionStates(scene, count, seed) : scene.randomStates(count, seed);
}
}  // namespace gpu_planning_scene::core::benchmark
