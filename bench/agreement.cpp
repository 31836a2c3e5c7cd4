// bench_agreement [STATES [SEED]]: compares every checker with FCL in random states of every scene (default 20000
// states). Prints one line per scene and checker. Exit status 1 if answers differ and the rules for FCL's known errors
// (test/support/fcl_agreement.h) do not explain the difference, or if too few states are free or colliding.

#include <cstdlib>
#include <iostream>

#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/error.h"
#include "support/fcl_agreement.h"
#include "support/test_scenes.h"

using namespace gpu_planning_scene::core;

namespace
{
std::unique_ptr<StateChecker> makeChecker(const std::string& method, const std::shared_ptr<const PlanningScene>& scene)
{
  if (method == "cpu")
    return std::make_unique<CpuChecker>(scene);
  BatchCheckerOptions options;
  options.traversal = traversalFromName(method);
  options.device_only = true;
  return std::make_unique<BatchChecker>(scene, options);
}

bool compare(const std::string& method, const std::string& name, std::size_t count, std::uint64_t seed)
{
  const TestScene& scene = testScene(name);
  const std::vector<double> states = scene.randomStates(count, seed);
  const BatchResult result = makeChecker(method, scene.scene)->check(states.data(), count);
  const FclAgreement agreement = compareWithFcl(*scene.scene, states, result);
  const bool telling =
      agreement.free >= count / 10 && agreement.free <= count * 9 / 10 && agreement.world_hits >= count / 20;
  std::cout << name << ", " << method << ": " << agreement << ", " << result.undecided_states << " undecided"
            << (telling ? "" : " (too few or too many are free for a comparison)") << std::endl;
  return telling && agreement.failures.empty();
}
}  // namespace

int main(int argc, char** argv)
try
{
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 20000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::cout << count << " states, seed " << seed << std::endl;
  bool good = true;
  for (const std::string& name : testSceneNames())
  {
    if (const std::string missing = missingFor(name); !missing.empty())
    {
      std::cout << name << ": skipped, there is no " << missing << std::endl;
      continue;
    }
    for (const char* method : {"cpu", "breadth_first", "work_queue"})
      good = compare(method, name, count, seed) && good;
  }
  return good ? 0 : 1;
}
catch (const Error& error)
{
  std::cerr << error.what() << std::endl;
  return 2;
}
