// bench_throughput [STATES [REPEATS [SCENE...]]]: states per second of both traversals, of the CPU checker and of FCL,
// each on all cores, in one run. The methods take turns, so that a change of the machine's speed meets all of them;
// figures are medians over the repeats, ratios are medians of the ratios within a repeat. Prints a Markdown table.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <thread>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/device.h"
#include "gpu_planning_scene/error.h"
#include "support/fcl_peer.h"
#include "support/test_scenes.h"

using namespace gpu_planning_scene;

namespace
{
constexpr std::uint64_t kSeed = 1;

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// FCL on all cores: one copy of its models per thread, which takes states until there are none.
class FclOnAllCores
{
 public:
  explicit FclOnAllCores(const PlanningScene& scene) : robot_(scene.robot)
  {
    const auto problem = std::make_shared<const CollisionProblem>(makeProblem(scene, "", nullptr));
    for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
      peers_.push_back(std::make_unique<FclPeer>(problem));
  }

  std::vector<std::uint8_t> check(const std::vector<double>& states, std::size_t count)
  {
    std::vector<std::uint8_t> valid(count);
    std::atomic<std::size_t> next{0};
    const auto work = [&](FclPeer& peer)
    {
      std::vector<Eigen::Isometry3d> poses(robot_->links().size());
      constexpr std::size_t kChunk = 32;
      for (std::size_t begin = next.fetch_add(kChunk); begin < count; begin = next.fetch_add(kChunk))
        for (std::size_t i = begin; i < std::min(count, begin + kChunk); ++i)
        {
          robot_->linkPoses(&states[i * robot_->variables().size()], poses.data());
          peer.setState(poses.data());
          valid[i] = peer.firstCollision() ? 0 : 1;
        }
    };
    std::vector<std::thread> threads;
    for (auto& peer : peers_)
      threads.emplace_back(work, std::ref(*peer));
    for (std::thread& thread : threads)
      thread.join();
    return valid;
  }

 private:
  std::shared_ptr<const RobotModel> robot_;
  std::vector<std::unique_ptr<FclPeer>> peers_;
};

struct Method
{
  std::string name;
  std::function<std::vector<std::uint8_t>()> check;
  std::vector<double> rates = {};
};

std::shared_ptr<BatchChecker> onGpu(const TestScene& scene, Traversal traversal, std::size_t max_batch)
{
  BatchCheckerOptions options;
  options.traversal = traversal;
  options.max_batch = max_batch;
  options.cpu_below = 0;
  return std::make_shared<BatchChecker>(scene.scene, options);
}

void measure(const std::string& name, std::size_t count, std::size_t repeats)
{
  const TestScene& scene = testScene(name);
  const std::vector<double> states = scene.randomStates(count, kSeed);
  FclOnAllCores fcl(*scene.scene);
  std::vector<Method> methods = {{"FCL", [&] { return fcl.check(states, count); }}};
  const auto add = [&](const std::string& method, const std::shared_ptr<StateChecker>& checker) {
    methods.push_back({method, [&states, count, checker] { return checker->check(states.data(), count).valid; }});
  };
  add("CPU checker", std::make_shared<CpuChecker>(scene.scene));
  for (const std::size_t batch : {1024, 16384})
  {
    add("breadth-first, " + std::to_string(batch), onGpu(scene, Traversal::BreadthFirst, batch));
    add("work queues, " + std::to_string(batch), onGpu(scene, Traversal::WorkQueue, batch));
  }
  std::size_t valid = 0;
  std::size_t disagreements = 0;
  std::vector<std::uint8_t> reference;
  for (std::size_t repeat = 0; repeat <= repeats; ++repeat)
    for (Method& method : methods)
    {
      const auto start = std::chrono::steady_clock::now();
      const std::vector<std::uint8_t> result = method.check();
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (repeat > 0)  // the first round compiles shaders and warms caches
      {
        method.rates.push_back(static_cast<double>(count) / seconds);
        continue;
      }
      if (reference.empty())
      {
        reference = result;
        valid = static_cast<std::size_t>(std::count(result.begin(), result.end(), 1));
      }
      for (std::size_t i = 0; i < count; ++i)
        disagreements += result[i] != reference[i] ? 1 : 0;
    }
  for (const Method& method : methods)
  {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < repeats; ++i)
      ratios.push_back(method.rates[i] / methods.front().rates[i]);
    const auto [low, high] = std::minmax_element(method.rates.begin(), method.rates.end());
    std::printf("| %s | %zu | %.0f %% | %s | %.0f | %.0f ... %.0f | %.2f |\n", name.c_str(),
                scene.scene->robot->triangleCount(), 100.0 * static_cast<double>(valid) / static_cast<double>(count),
                method.name.c_str(), median(method.rates), *low, *high, median(ratios));
  }
  std::printf("| %s | | | verdicts unlike FCL's, all methods | %zu | | |\n", name.c_str(), disagreements);
  std::fflush(stdout);
}
}  // namespace

int main(int argc, char** argv)
try
{
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 16384;
  const std::size_t repeats = argc > 2 ? std::max(1UL, std::strtoul(argv[2], nullptr, 10)) : 7;
  std::vector<std::string> names(argv + std::min(argc, 3), argv + argc);
  if (names.empty())
    names = testSceneNames();
  std::printf("%zu random states, seed %llu, %zu repeats, %u cores\n", count, static_cast<unsigned long long>(kSeed),
              repeats, std::thread::hardware_concurrency());
  for (const Device& device : listDevices())
    std::printf("device %d: %s\n", device.index, device.renderer.c_str());
  std::printf(
      "\n| scene | triangles | valid | method, batch | states/s | spread | of FCL |\n|---|---|---|---|---|---|---|\n");
  for (const std::string& name : names)
    if (const std::string missing = missingFor(name); missing.empty())
      measure(name, count, repeats);
    else
      std::printf("| %s | | | skipped, there is no %s | | | |\n", name.c_str(), missing.c_str());
  return 0;
}
catch (const Error& error)
{
  std::cerr << error.what() << std::endl;
  return 2;
}
