// Time from a scene change to the next answer: one of a thousand objects is moved, the method takes the new scene, and
// one state is checked. This is measured once per robot of the scenes, in a world that is made for this purpose.

#include <set>

#include "benchmark/csv_table.h"
#include "benchmark/settings.h"
#include "benchmark/statistics.h"
#include "benchmark/truth.h"
#include "benchmark/updates.h"
#include "gpu_planning_scene/error.h"
#include "support/obstacles.h"
#include "support/test_scenes.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr std::size_t kObjects = 1000;

/// The robot of the scene among boxes. Each box has a different size, so each has its own tree. No box is near enough
/// to collide in every state.
TestScene amongBoxes(const TestScene& scene)
{
  TestScene made = scene;
  PlanningScene changed = *scene.scene;
  changed.objects = generateObstacles({kObjects, {0.0, 0.0, 0.6}, 0.8, 4.0, 0.2}, 3);
  for (std::size_t i = 0; i < changed.objects.size(); ++i)
    changed.objects[i].shapes = {{Box{{0.05 + 1e-4 * static_cast<double>(i), 0.1, 0.1}}}};
  made.scene = std::make_shared<const PlanningScene>(std::move(changed));
  return made;
}
}  // namespace

std::size_t measureMovedObjects(const Settings& settings)
{
  CsvTable table(settings.out, "updates.csv",
                 {"robot", "objects", "method", "title", "family", "updates", "p50_ms", "p90_ms", "p99_ms", "max_ms"});
  ProgressBar progress("updates", settings.scenes.size() * settings.methods.size());
  std::size_t done = 0;
  std::size_t wrong = 0;
  std::set<std::string> robots;
  for (const std::string& name : settings.scenes)
  {
    const std::string robot = testScene(name).scene->robot->name();
    if (!robots.insert(robot).second)
    {
      progress.update(done += settings.methods.size());
      continue;
    }
    const TestScene scene = amongBoxes(testScene(name));
    if (CpuChecker(scene.scene).report().always_colliding)
      throw Error(robot + " among " + std::to_string(kObjects) +
                  " boxes collides in every state, so it cannot be measured");
    const Updates updates(scene, settings.quick ? 5 : 200);
    for (const MethodInfo& info : settings.methods)
    {
      progress.update(done++);
      if (!info.responsive)
        continue;
      const std::unique_ptr<Method> method = info.make(scene.scene, settings.method);
      const Updates::Result result = updates.measure(info, *method);
      wrong +=
          reportWrongAnswers(robot + ", one of " + std::to_string(kObjects) + " objects moved", info, result.wrong);
      std::vector<double> times;
      for (const double seconds : result.seconds)
        times.push_back(1e3 * seconds);
      if (!times.empty())
        table.add({robot, kObjects, info.name, info.title, info.family, times.size(), median(times),
                   percentile(times, 0.9), percentile(times, 0.99), percentile(times, 1.0)});
    }
  }
  return wrong;
}
}  // namespace gpu_planning_scene::core::benchmark
