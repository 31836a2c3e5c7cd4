// Time per state against the batch size, the number of triangles of the robot, and the number of objects.

#include <algorithm>
#include <cmath>
#include <iostream>

#include "benchmark/csv_table.h"
#include "benchmark/settings.h"
#include "benchmark/statistics.h"
#include "benchmark/truth.h"
#include "benchmark/updates.h"
#include "gpu_planning_scene/error.h"
#include "support/generated_arm.h"
#include "support/obstacles.h"
#include "support/test_scenes.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr std::size_t kStates = 4096;
constexpr std::size_t kMaxTrianglesOfPeers = 1000000;  // FCL's trees of more need too much memory

class Growth
{
 public:
  /// `rows`: number of rows per method, for the progress bar.
  Growth(const Settings& settings, std::size_t rows)
    : settings_(settings),
      table_(settings.out, "growth.csv",
             {"with", "amount", "method", "title", "family", "batch", "us_a_state", "cpu_us_a_state", "load_robot_s",
              "build_s", "update_s", "valid_share"}),
      progress_("growth", rows * countOf(settings.methods))
  {
  }

  /// Measures each method in one scene. `with`: the quantity that grows; `load`: seconds to load the robot.
  void measure(const std::string& with, std::size_t amount, const TestScene& scene, double load)
  {
    if (CpuChecker(scene.scene).report().always_colliding)
      throw Error("the scene with " + std::to_string(amount) + " " + with +
                  " collides in every state, so it cannot be measured");
    const std::size_t count = settings_.quick ? 256 : kStates;
    const std::vector<double> states = scene.randomStates(count, settings_.seed);
    const std::vector<std::uint8_t> truth = Truth(scene.scene).check(states.data(), count);
    const Updates updates(scene, settings_.quick ? 2 : 9);
    for (const MethodInfo& info : settings_.methods)
    {
      if (!info.responsive)
        continue;
      if (with == "triangles" && amount > kMaxTrianglesOfPeers && info.family == "FCL")
      {
        std::cerr << "growth: " << info.title << " is left out with " << amount
                  << " triangles: its trees take too much memory\n";
        continue;
      }
      std::unique_ptr<Method> method;
      const double build = secondsOf([&] { method = info.make(scene.scene, settings_.method); });
      time(with, amount, info, *method, states, truth, {load, build}, &updates);
    }
  }

  void measureBatches(const TestScene& scene, const std::vector<std::size_t>& batches)
  {
    const std::vector<double> states = scene.randomStates(batches.back(), settings_.seed);
    const std::vector<std::uint8_t> truth = Truth(scene.scene).check(states.data(), batches.back());
    for (const MethodInfo& info : settings_.methods)
    {
      if (!info.responsive)
        continue;
      const std::unique_ptr<Method> method = info.make(scene.scene, settings_.method);
      for (const std::size_t batch : batches)
        time("states", batch, info, *method, states,
             {truth.begin(), truth.begin() + static_cast<std::ptrdiff_t>(batch)}, {}, nullptr);
    }
  }

  std::size_t wrong() const { return wrong_; }

 private:
  static std::size_t countOf(const std::vector<MethodInfo>& methods)
  {
    return static_cast<std::size_t>(std::count_if(
        methods.begin(), methods.end(), [](const MethodInfo& info) { return info.responsive; }));
  }

  struct Once
  {
    double load = NAN;
    double build = NAN;
  };

  /// Adds a row with the median of repeated calls, each with as many states as `truth`. The calls repeat for the time
  /// of the settings, and at least three times.
  void time(const std::string& with, std::size_t amount, const MethodInfo& info, Method& method,
            const std::vector<double>& states, const std::vector<std::uint8_t>& truth, const Once& once,
            const Updates* updates)
  {
    const std::size_t batch = truth.size();
    std::size_t wrong = 0;
    method.check(states.data(), batch);
    std::vector<double> wall;
    std::vector<double> cpu;
    const Stopwatch all;
    while (wall.size() < 3 || (all.seconds() < settings_.seconds && wall.size() < 100))
    {
      const Stopwatch watch;
      const std::vector<std::uint8_t> answers = method.check(states.data(), batch);
      wall.push_back(1e6 * watch.seconds() / static_cast<double>(batch));
      cpu.push_back(1e6 * watch.cpuSeconds() / static_cast<double>(batch));
      wrong += wrongAnswers(info, answers, truth);
    }
    const Updates::Result update = updates != nullptr ? updates->measure(info, method) : Updates::Result();
    wrong_ += reportWrongAnswers("growth, " + std::to_string(amount) + " " + with, info, wrong + update.wrong);
    table_.add({with, amount, info.name, info.title, info.family, batch, median(wall), median(cpu), once.load,
                once.build, median(update.seconds), validShare(truth)});
    progress_.update(++done_);
  }

  const Settings& settings_;
  CsvTable table_;
  ProgressBar progress_;
  std::size_t done_ = 0;
  std::size_t wrong_ = 0;
};

TestScene sceneOf(const std::shared_ptr<const RobotModel>& robot, std::vector<WorldObject> objects)
{
  PlanningScene scene(robot);
  scene.objects = std::move(objects);
  TestScene made;
  for (const Variable& variable : robot->variables())
  {
    made.lower.push_back(variable.lower);
    made.upper.push_back(variable.upper);
  }
  made.scene = std::make_shared<const PlanningScene>(std::move(scene));
  return made;
}

/// Obstacles with a constant number per cubic metre: the world grows outwards with the number of objects. There is no
/// obstacle at the base of the generated arm, because it would collide in every state.
std::vector<WorldObject> world(std::size_t objects)
{
  const Eigen::Vector3d center(0.0, 0.0, 0.5);
  const double inner = 0.5;
  const double outer = std::cbrt(inner * inner * inner + 0.16 * static_cast<double>(objects));
  const double off_base = 0.45;  // metres from the axis of the base; the longest diagonal of an obstacle is 0.35 m
  // generateObstacles distributes the distances uniformly between the two radii. This maps them to a uniform
  // distribution over the volume.
  std::vector<WorldObject> kept;
  for (WorldObject& object : generateObstacles({2 * objects + 10, center, inner, outer, 0.2}, 1))
  {
    const Eigen::Vector3d offset = object.pose.translation() - center;
    const double share = (offset.norm() - inner) / (outer - inner);
    const double distance = std::cbrt(inner * inner * inner + share * (outer * outer * outer - inner * inner * inner));
    object.pose.translation() = center + distance * offset.normalized();
    const bool at_base = object.pose.translation().head<2>().norm() < off_base && object.pose.translation().z() < 0.5;
    if (!at_base && kept.size() < objects)
      kept.push_back(std::move(object));
  }
  return kept;
}
}  // namespace

std::size_t measureGrowth(const Settings& settings)
{
  using Amounts = std::vector<std::size_t>;
  const Amounts batches = settings.quick ? Amounts{1, 16, 256} : Amounts{1, 4, 16, 64, 256, 1024, 4096, 16384, 65536};
  const Amounts triangles = settings.quick ? Amounts{1000, 10000} : Amounts{1000, 10000, 100000, 1000000, 3000000};
  const Amounts objects = settings.quick ? Amounts{1, 100} : Amounts{1, 10, 100, 1000, 10000};
  Growth growth(settings, batches.size() + triangles.size() + objects.size());
  growth.measureBatches(testScene(settings.scenes.front()), batches);
  const std::vector<WorldObject> boxes = boxesAround({0.0, 0.0, 0.5}, 8, 0.5, 0.3);
  for (const std::size_t amount : triangles)
  {
    const GeneratedArm arm(amount);
    std::shared_ptr<const RobotModel> robot;
    const double load = secondsOf([&] { robot = arm.load(); });
    growth.measure("triangles", amount, sceneOf(robot, boxes), load);
  }
  const auto robot = GeneratedArm(10000).load();
  for (const std::size_t amount : objects)
    growth.measure("objects", amount, sceneOf(robot, world(amount)), NAN);
  return growth.wrong();
}
}  // namespace gpu_planning_scene::core::benchmark
