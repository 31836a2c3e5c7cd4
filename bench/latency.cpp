// bench_latency [STATES [SCENE...]]: how long one state takes, asked for alone, on one thread: kinematics and the way
// to the first collision, by the CPU checker and by FCL OBBRSS. A state's time is the least of five, taken in turns.
// Prints a Markdown table.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <limits>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "support/fcl_peer.h"
#include "support/test_scenes.h"

using namespace gpu_planning_scene;

namespace
{
constexpr std::uint64_t kSeed = 1;
constexpr int kRepeats = 5;

double percentile(std::vector<double> values, double share)
{
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

template <class Work>
double microseconds(const Work& work)
{
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

void measure(const std::string& name, std::size_t count)
{
  const TestScene& scene = testScene(name);
  const RobotModel& robot = *scene.scene->robot;
  const std::vector<double> states = scene.randomStates(count, kSeed);
  CpuChecker ours(scene.scene);
  FclPeer fcl(std::make_shared<const CollisionProblem>(makeProblem(*scene.scene, "", nullptr)));
  std::vector<Eigen::Isometry3d> poses(robot.links().size());

  std::vector<double> our_times(count, std::numeric_limits<double>::infinity());
  std::vector<double> fcl_times = our_times;
  for (int repeat = 0; repeat < kRepeats; ++repeat)
    for (std::size_t i = 0; i < count; ++i)
    {
      const double* state = &states[i * robot.variables().size()];
      our_times[i] = std::min(our_times[i], microseconds([&] { ours.check(state, 1); }));
      fcl_times[i] = std::min(fcl_times[i], microseconds(
                                                [&]
                                                {
                                                  robot.linkPoses(state, poses.data());
                                                  fcl.setState(poses.data());
                                                  fcl.firstCollision();
                                                }));
    }
  std::size_t slower = 0;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < count; ++i)
  {
    slower += our_times[i] > fcl_times[i] ? 1 : 0;
    ratios.push_back(our_times[i] / fcl_times[i]);
  }
  std::printf("| %s | %.1f / %.1f | %.1f / %.1f | %.2f | %.2f | %.2f %% |\n", name.c_str(), percentile(our_times, 0.5),
              percentile(our_times, 0.99), percentile(fcl_times, 0.5), percentile(fcl_times, 0.99),
              percentile(ratios, 0.5), percentile(ratios, 0.99),
              100.0 * static_cast<double>(slower) / static_cast<double>(count));
  std::fflush(stdout);
}
}  // namespace

int main(int argc, char** argv)
try
{
  const std::size_t count = argc > 1 ? std::max(1UL, std::strtoul(argv[1], nullptr, 10)) : 2000;
  std::vector<std::string> names(argv + std::min(argc, 2), argv + argc);
  if (names.empty())
    names = testSceneNames();
  std::printf("%zu random states, seed %llu; median / 99th percentile in microseconds\n\n", count,
              static_cast<unsigned long long>(kSeed));
  std::printf("| scene | CPU checker | FCL | ratio, median | 99 %% below | states slower than FCL |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (const std::string& name : names)
    if (const std::string missing = missingFor(name); missing.empty())
      measure(name, count);
    else
      std::printf("| %s | skipped, there is no %s | | | | |\n", name.c_str(), missing.c_str());
  return 0;
}
catch (const Error& error)
{
  std::cerr << error.what() << std::endl;
  return 2;
}
