#include "base/parallel_for.h"
#include "benchmark/method.h"
#include "peers/vamp/vamp_check.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
/// VAMP's check on all cores. The times include VAMP's own kinematics.
class Vamp : public Method
{
 public:
  explicit Vamp(const PlanningScene& scene)
    : check_(scene, vampCylindersOf(scene.name)), width_(scene.robot->variables().size())
  {
  }

  std::vector<std::uint8_t> check(const double* states, std::size_t count) override
  {
    std::vector<std::uint8_t> valid(count);
    parallelFor(count, kChunk,
                [&](std::size_t begin, std::size_t end)
                { check_.check(states + begin * width_, end - begin, &valid[begin]); });
    return valid;
  }

 private:
  static constexpr std::size_t kChunk = 256;  // states of a motion stay together
  VampCheck check_;
  std::size_t width_;
};
}  // namespace

std::vector<MethodInfo> vampMethods()
{
  if (!whyNoVamp().empty())
    return {};
  MethodInfo info;
  info.name = kVampMethod;
  info.title = "VAMP, its spheres of the ur5";
  info.family = "VAMP";
  info.paddable = false;
  info.refuses = whyVampRefuses;
  info.make = [](const auto& scene, const MethodOptions&) { return std::make_unique<Vamp>(*scene); };
  return {info};
}
}  // namespace gpu_planning_scene::core::benchmark
