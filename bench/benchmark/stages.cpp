// The stages of the CPU checker with proofs: how many states each of them decides, and its time.

#include "benchmark/csv_table.h"
#include "benchmark/settings.h"
#include "collision/cpu/cpu_scene.h"
#include "collision/proofs/proof_worker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
/// Checks random states until there are proofs.
void waitUntilProven(CpuChecker& checker, const std::vector<double>& states, std::size_t count)
{
  for (std::size_t checked = 0; checked <= kStatesBeforeProofs; checked += count)
    checker.check(states.data(), count);
  checker.check(states.data(), count);  // asks for the proofs
  waitForProofs();
}
}  // namespace

std::size_t measureStages(const Settings& settings)
{
  CsvTable table(settings.out, "stages.csv", {"scene", "stage", "decided_share", "ns_a_state"});
  for (const std::string& name : settings.scenes)
  {
    const TestScene& scene = testScene(name);
    CpuChecker checker(scene.scene);
    const std::vector<double> states = scene.randomStates(settings.states, settings.seed);
    waitUntilProven(checker, states, settings.states);
    const std::vector<DecidedStates> before = checker.report().decided;
    for (std::size_t repeat = 0; repeat < settings.repeats; ++repeat)
      checker.check(states.data(), settings.states);
    const auto all = static_cast<double>(settings.states * settings.repeats);
    for (const DecidedStates& stage : checker.report().decided)
    {
      double states_before = 0.0;
      for (const DecidedStates& other : before)
        states_before += other.by == stage.by ? static_cast<double>(other.states) : 0.0;
      const double decided = static_cast<double>(stage.states) - states_before;
      if (decided > 0.0 || stage.nanoseconds > 0.0)
        table.add({name, stage.by, decided / all, stage.nanoseconds});
    }
  }
  return 0;
}
}  // namespace gpu_planning_scene::core::benchmark
