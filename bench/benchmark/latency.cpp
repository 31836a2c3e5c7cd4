// Time of one call with a single state or a small batch. Methods take turns in a few rounds of the same calls. The
// percentiles include all calls of all rounds. The ratios to FCL compare the shortest time of each call.

#include <algorithm>
#include <limits>
#include <map>

#include "benchmark/csv_table.h"
#include "benchmark/settings.h"
#include "benchmark/statistics.h"
#include "benchmark/truth.h"
#include "support/test_scenes.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr std::array<std::size_t, 4> kSizes = {1, 8, 64, 1024};

struct Timed
{
  const MethodInfo* info;
  std::unique_ptr<Method> method;
  std::vector<double> all = {};    // microseconds
  std::vector<double> least = {};  // shortest time of each call
};

/// Number of calls of a size: fewer calls for larger sizes.
std::size_t callsOf(std::size_t size, bool quick)
{
  const std::size_t limit = quick ? 20 : 1000;
  return std::max<std::size_t>(quick ? 2 : 20, limit / size);
}

/// Returns the number of wrong answers.
std::size_t timeCalls(const TestScene& scene, std::vector<Timed>& methods, const std::vector<double>& states,
                      const std::vector<std::uint8_t>& truth, std::size_t size, int rounds)
{
  const std::size_t width = scene.lower.size();
  const std::size_t calls = truth.size() / size;
  std::map<const MethodInfo*, std::size_t> wrong;
  for (Timed& timed : methods)
  {
    timed.method->check(states.data(), size);  // keeps one-time work out of the timing
    timed.all.clear();
    timed.least.assign(calls, std::numeric_limits<double>::infinity());
  }
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < calls; ++i)
      for (Timed& timed : methods)
      {
        std::vector<std::uint8_t> answers;
        timed.all.push_back(1e6 * secondsOf([&] { answers = timed.method->check(&states[i * size * width], size); }));
        timed.least[i] = std::min(timed.least[i], timed.all.back());
        wrong[timed.info] += wrongAnswers(*timed.info, answers, truth, i * size);
      }
  std::size_t sum = 0;
  for (const auto& [info, count] : wrong)
    sum += reportWrongAnswers(scene.name + ", latency of " + std::to_string(size) + " states", *info, count);
  return sum;
}

/// Ratio of each call to the same call of the method `name`; empty without this method.
std::vector<double> ratiosTo(const char* name, const Timed& timed, const std::vector<Timed>& methods)
{
  const auto reference =
      std::find_if(methods.begin(), methods.end(), [&](const Timed& other) { return other.info->name == name; });
  std::vector<double> ratios;
  for (std::size_t i = 0; reference != methods.end() && i < timed.least.size(); ++i)
    ratios.push_back(timed.least[i] / reference->least[i]);
  return ratios;
}

void addRows(const std::string& scene, std::size_t size, const std::vector<Timed>& methods, CsvTable& table)
{
  for (const Timed& timed : methods)
  {
    const std::vector<double> ratios = ratiosTo(kReferenceMethod, timed, methods);
    const auto slower =
        static_cast<double>(std::count_if(ratios.begin(), ratios.end(), [](double ratio) { return ratio > 1.0; }));
    table.add({scene, timed.info->name, timed.info->title, timed.info->family, size, timed.all.size(),
               median(timed.all), percentile(timed.all, 0.9), percentile(timed.all, 0.99), percentile(timed.all, 1.0),
               median(ratios), slower / static_cast<double>(ratios.size()),
               median(ratiosTo(kOrderedMethod, timed, methods))});
  }
}
}  // namespace

std::size_t measureLatency(const Settings& settings)
{
  CsvTable table(settings.out, "latency.csv",
                 {"scene", "method", "title", "family", "batch", "calls", "p50_us", "p90_us", "p99_us", "max_us",
                  "of_fcl_obbrss", "slower_than_fcl_share", "of_fcl_ordered"});
  ProgressBar progress("latency", settings.scenes.size());
  std::size_t done = 0;
  std::size_t wrong = 0;
  for (const std::string& name : settings.scenes)
  {
    progress.update(done++);
    const TestScene& scene = testScene(name);
    Truth exact(scene.scene);
    std::vector<Timed> methods;
    for (const MethodInfo& info : settings.methods)
      if (info.responsive)
        methods.push_back({&info, info.make(scene.scene, settings.method)});
    for (const std::size_t size : kSizes)
    {
      const std::size_t calls = callsOf(size, settings.quick);
      const std::vector<double> states = scene.randomStates(calls * size, settings.seed);
      wrong +=
          timeCalls(scene, methods, states, exact.check(states.data(), calls * size), size, settings.quick ? 2 : 5);
      addRows(name, size, methods, table);
    }
  }
  return wrong;
}
}  // namespace gpu_planning_scene::core::benchmark
