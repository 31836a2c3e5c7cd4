// The time that each kernel, copy and clear takes on the device.

#include <algorithm>
#include <iostream>

#include "benchmark/csv_table.h"
#include "benchmark/gl_timer.h"
#include "benchmark/settings.h"
#include "collision/cpu/cpu_scene.h"
#include "collision/proofs/proof_worker.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
/// Lets the method check random states until it has parts of their final size, and, unless the run is quick, proofs.
void warmUp(Method& method, const std::vector<double>& states, std::size_t count, bool quick)
{
  constexpr std::size_t kGrowing = 8;  // the sizes of parts double from batch to batch
  for (std::size_t checked = 0; !quick && checked <= kStatesBeforeProofs; checked += count)
    method.check(states.data(), count);
  if (!quick)
    waitForProofs();
  for (std::size_t i = 0; i < (quick ? 1 : kGrowing); ++i)
    method.check(states.data(), count);
}

using Row = std::pair<std::string, CommandTime>;

/// The kinds of commands, the slowest first.
std::vector<Row> rowsOf(const std::map<std::string, CommandTime>& times)
{
  std::vector<Row> rows(times.begin(), times.end());
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.second.seconds > b.second.seconds; });
  return rows;
}
}  // namespace

std::size_t measureKernels(const Settings& settings)
{
  CsvTable table(
      settings.out, "kernels.csv",
      {"scene", "method", "batch", "command", "calls_a_batch", "us_a_batch", "mean_us", "longest_us", "share"});
  for (const std::string& name : settings.scenes)
    for (const MethodInfo& info : settings.methods)
    {
      if (info.name != "ours_work_queue" && info.name != "ours_breadth_first")
        continue;
      const TestScene& scene = testScene(name);
      const std::unique_ptr<Method> method = info.make(scene.scene, settings.method);
      for (const std::size_t batch : settings.batches)
      {
        const std::vector<double> states = scene.randomStates(batch, settings.seed);
        warmUp(*method, states, batch, settings.quick);
        const GlTimer timer;
        for (std::size_t repeat = 0; repeat < settings.repeats; ++repeat)
          method->check(states.data(), batch);
        const std::vector<Row> rows = rowsOf(GlTimer::times());
        double all = 0.0;
        for (const Row& row : rows)
          all += row.second.seconds;
        const auto repeats = static_cast<double>(settings.repeats);
        for (const auto& [command, time] : rows)
          table.add({name, info.name, batch, command, static_cast<double>(time.calls) / repeats,
                     1e6 * time.seconds / repeats, 1e6 * time.seconds / static_cast<double>(time.calls),
                     1e6 * time.longest, time.seconds / all});
        std::cerr << name << ", " << info.name << ", " << batch << " states: " << 1e6 * all / repeats
                  << " us on the device" << std::endl;
      }
    }
  return 0;
}
}  // namespace gpu_planning_scene::core::benchmark
