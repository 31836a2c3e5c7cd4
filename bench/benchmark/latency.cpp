// How long one call takes: single states and small batches. A call's time is the least of a few, taken in turns.

#include <algorithm>
#include <limits>
#include <map>

#include "benchmark/csv_table.h"
#include "benchmark/settings.h"
#include "benchmark/statistics.h"
#include "support/test_scenes.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::benchmark
{
namespace
{
constexpr std::array<std::size_t, 4> kSizes = {1, 8, 64, 1024};

struct Timed
{
  const MethodInfo* info;
  std::unique_ptr<Method> method;
  std::vector<double> least = {};  // microseconds, of each call
};

/// How many calls of a size: fewer of the large ones.
std::size_t callsOf(std::size_t size, bool quick)
{
  const std::size_t most = quick ? 20 : 1000;
  return std::max<std::size_t>(quick ? 2 : 20, most / size);
}

void timeCalls(std::vector<Timed>& methods, const std::vector<double>& states, std::size_t width, std::size_t size,
               std::size_t calls, int rounds)
{
  for (Timed& timed : methods)
  {
    timed.method->check(states.data(), size);  // what is done once is not to be timed
    timed.least.assign(calls, std::numeric_limits<double>::infinity());
  }
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < calls; ++i)
      for (Timed& timed : methods)
      {
        const double seconds = secondsOf([&] { timed.method->check(&states[i * size * width], size); });
        timed.least[i] = std::min(timed.least[i], 1e6 * seconds);
      }
}

void addRows(const std::string& scene, std::size_t size, const std::vector<Timed>& methods, CsvTable& table)
{
  const auto reference = std::find_if(methods.begin(), methods.end(),
                                      [](const Timed& timed) { return timed.info->name == kReferenceMethod; });
  for (const Timed& timed : methods)
  {
    std::vector<double> ratios;
    double slower = 0.0;
    for (std::size_t i = 0; reference != methods.end() && i < timed.least.size(); ++i)
    {
      ratios.push_back(timed.least[i] / reference->least[i]);
      slower += ratios.back() > 1.0 ? 1.0 : 0.0;
    }
    table.add({scene, timed.info->name, timed.info->title, timed.info->family, size, timed.least.size(),
               percentile(timed.least, 0.5), percentile(timed.least, 0.9), percentile(timed.least, 0.99),
               percentile(timed.least, 1.0), median(ratios), slower / static_cast<double>(ratios.size())});
  }
}
}  // namespace

void measureLatency(const Settings& settings)
{
  CsvTable table(settings.out, "latency.csv",
                 {"scene", "method", "title", "family", "batch", "calls", "p50_us", "p90_us", "p99_us", "max_us",
                  "of_fcl_obbrss", "slower_than_fcl_share"});
  ProgressBar progress("latency", settings.scenes.size());
  std::size_t done = 0;
  for (const std::string& name : settings.scenes)
  {
    progress.update(done++);
    const TestScene& scene = testScene(name);
    std::vector<Timed> methods;
    for (const MethodInfo& info : settings.methods)
      if (info.responsive)
        methods.push_back({&info, info.make(scene.scene, settings.method)});
    for (const std::size_t size : kSizes)
    {
      const std::size_t calls = callsOf(size, settings.quick);
      timeCalls(methods, scene.randomStates(calls * size, settings.seed), scene.lower.size(), size, calls,
                settings.quick ? 2 : 5);
      addRows(name, size, methods, table);
    }
  }
}
}  // namespace gpu_planning_scene::benchmark
