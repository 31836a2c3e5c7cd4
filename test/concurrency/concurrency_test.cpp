// Several threads check states while another thread changes the scene. Each answer must belong entirely to the scene
// whose revision it names.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr int kCheckingThreads = 3;
constexpr std::size_t kStates = 40;

/// A slider on a rail, and a wall that obstructs the slider in scenes with an odd revision.
class Scenes
{
 public:
  Scenes()
  {
    robot_ = RobotModel::fromXml(R"(<robot name="slider">
      <link name="rail"/>
      <link name="carriage"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
      <joint name="slide" type="prismatic"><parent link="rail"/><child link="carriage"/><axis xyz="1 0 0"/>
        <limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>)",
                                 "", {});
  }

  std::shared_ptr<const PlanningScene> of(std::uint64_t revision) const
  {
    auto scene = std::make_shared<PlanningScene>(robot_);
    const double y = revision % 2 == 1 ? 0.0 : 1.0;
    scene->objects.push_back({"wall", Eigen::Isometry3d(Eigen::Translation3d(0.8, y, 0.0)), {{Box{{0.1, 0.4, 0.4}}}}});
    scene->revision = revision;
    return scene;
  }

 private:
  std::shared_ptr<const RobotModel> robot_;
};

void checkWhileTheSceneChanges(StateChecker& checker, const Scenes& scenes, std::uint64_t revisions)
{
  std::vector<double> states;
  for (std::size_t i = 0; i < kStates; ++i)
    states.push_back((static_cast<double>(i) + 0.5) / kStates);
  std::atomic<bool> done{false};
  std::atomic<int> wrong{0};
  std::atomic<int> answers{0};
  std::vector<std::thread> threads;
  threads.reserve(kCheckingThreads);
  for (int t = 0; t < kCheckingThreads; ++t)
  {
    threads.emplace_back(
        [&]
        {
          while (!done)
          {
            const BatchResult result = checker.check(states.data(), kStates);
            for (std::size_t i = 0; i < kStates; ++i)
            {
              // The wall extends from 0.75 to 0.85, and the carriage 0.05 to both sides.
              const bool hits = result.revision % 2 == 1 && states[i] > 0.7 && states[i] < 0.9;
              wrong += result.valid[i] == (hits ? 0 : 1) ? 0 : 1;
            }
            ++answers;
          }
        });
  }
  for (std::uint64_t revision = 1; revision <= revisions || answers < 3 * kCheckingThreads; ++revision)
  {
    checker.setScene(scenes.of(revision));
    std::this_thread::yield();
  }
  done = true;
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(wrong, 0) << "in " << answers << " answers";
}

TEST(Concurrency, AnswersOfTheCpuBelongToTheirRevision)
{
  const Scenes scenes;
  CpuChecker checker(scenes.of(0));
  checkWhileTheSceneChanges(checker, scenes, 100);
}

TEST(Concurrency, ChecksOfTheCpuRunSideBySide)
{
  const Scenes scenes;
  CpuChecker checker(scenes.of(1));
  // So many states that their check takes about a second.
  const std::vector<double> some(100'000, 0.1);
  const double seconds = checker.check(some.data(), some.size()).seconds;
  const std::vector<double> many(static_cast<std::size_t>(100'000.0 / std::clamp(seconds, 0.01, 1.0)), 0.1);
  const double one = 0.8;
  double seconds_of_many = 0.0;
  std::thread other([&] { seconds_of_many = checker.check(many.data(), many.size()).seconds; });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the other check has begun
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(checker.check(&one, 1).valid.front(), 0);
  const double seconds_of_one = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  other.join();
  EXPECT_LT(seconds_of_one, 0.5 * seconds_of_many) << "the check waited for another one";
}

/// So many states that proofs are made while the threads check. A check may begin with them and another one without.
TEST(Concurrency, AnswersOfTheCpuDoNotDependOnChecksBesideThem)
{
  setenv("GPU_PLANNING_SCENE_PROOF_CACHE", "off", 1);
  const Scenes scenes;
  CpuChecker checker(scenes.of(1));
  std::atomic<int> wrong{0};
  std::atomic<bool> uses_proofs{false};
  std::vector<std::thread> threads;
  for (int t = 0; t < kCheckingThreads; ++t)
    threads.emplace_back(
        [&, t]
        {
          const std::size_t count = t == 0 ? 1000 : 100;
          std::vector<double> states;
          for (std::size_t i = 0; i < count; ++i)
            states.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(count));
          JointNeighbourhood around;
          around.travel = {{0.02, 0.0}};
          around.rows.assign(count, 0);
          constexpr int kRepeats = 100;  // before and after the proofs are used first
          for (int repeat = 0, left = kRepeats; left > 0 && repeat < 20'000; ++repeat)
          {
            if (t == 0 && repeat % 10 == 0)
              uses_proofs = checker.report().decided.size() > 1;
            left -= uses_proofs ? 1 : 0;
            const bool has_margins = repeat % 2 == t % 2;
            const BatchResult result = checker.check(states.data(), count, "", has_margins ? &around : nullptr);
            for (std::size_t i = 0; i < count; ++i)
            {
              const double gap = std::max(0.7 - states[i], states[i] - 0.9);  // between the carriage and the wall
              const double needed = has_margins ? 0.02 : 0.0;
              // A gap of little more than the margin need not be proven.
              if (std::abs(gap - needed) > 1e-3)
                wrong += result.valid[i] == (gap > needed ? 1 : 0) ? 0 : 1;
            }
          }
        });
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_TRUE(uses_proofs);
}

TEST(Concurrency, AnswersOfTheGpuBelongToTheirRevision)
{
  const Scenes scenes;
  BatchCheckerOptions options;
  options.device_only = true;
  BatchChecker checker(scenes.of(0), options);
  checkWhileTheSceneChanges(checker, scenes, 20);
}
}  // namespace
}  // namespace gpu_planning_scene::core
