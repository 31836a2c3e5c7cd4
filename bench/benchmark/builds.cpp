// Time and memory of the start and of scene changes: loading a robot, building, the first check, moving one object.

#include <algorithm>

#include "benchmark/csv_table.h"
#include "benchmark/memory.h"
#include "benchmark/settings.h"
#include "benchmark/statistics.h"
#include "benchmark/truth.h"
#include "benchmark/updates.h"
#include "support/test_scenes.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr std::size_t kBatch = 16384;  // states of the check that determines the peak memory
}  // namespace

std::size_t measureBuilds(const Settings& settings)
{
  CsvTable table(settings.out, "build.csv",
                 {"scene", "triangles", "objects", "method", "title", "family", "load_robot_s", "build_s",
                  "first_check_s", "next_check_s", "update_s", "peak_host_mib", "device_mib"});
  const DeviceMemory device(settings.method.device);
  ProgressBar progress("build", settings.scenes.size() * settings.methods.size());
  std::size_t done = 0;
  std::size_t wrong = 0;
  for (const std::string& name : settings.scenes)
  {
    const TestScene& scene = testScene(name);
    const double load = secondsOf([&] { loadRobotOf(name); });
    const std::vector<double> states = scene.randomStates(settings.quick ? 256 : kBatch, settings.seed);
    const std::size_t count = states.size() / scene.lower.size();
    const std::vector<std::uint8_t> truth = Truth(scene.scene).check(states.data(), count);
    const Updates updates(scene, settings.quick ? 2 : 9);
    for (const MethodInfo& info : settings.methods)
    {
      progress.update(done++);
      if (!info.responsive)
        continue;
      const HostMemory host;
      const double device_before = device.used();
      std::unique_ptr<Method> method;
      const double build = secondsOf([&] { method = info.make(scene.scene, settings.method); });
      std::vector<std::uint8_t> answers;
      const double first = secondsOf([&] { answers = method->check(states.data(), 1); });
      std::size_t of_this = wrongAnswers(info, answers, truth);
      const double next = secondsOf([&] { answers = method->check(states.data(), 1); });
      of_this += wrongAnswers(info, answers, truth);
      of_this += wrongAnswers(info, method->check(states.data(), count), truth);
      const Updates::Result update = updates.measure(info, *method);
      wrong += reportWrongAnswers(name + ", build and updates", info, of_this + update.wrong);
      table.add({name, scene.scene->robot->triangleCount(), scene.scene->objects.size(), info.name, info.title,
                 info.family, load, build, first, next, median(update.seconds), host.peak(),
                 device.used() - device_before});
    }
  }
  return wrong;
}
}  // namespace gpu_planning_scene::core::benchmark
