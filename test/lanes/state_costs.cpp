// state_costs SCENE STATES TRAVERSAL [GROUPS]: checks STATES random states of a benchmark scene (test_scenes.h) on the
// simulated device, with exact arithmetic, and prints the work of the device and of the host (work_counts.h). Before,
// it checks two batches of equal size, so that the device has proofs, a learned order of queries and parts of their
// final size. GROUPS: work groups in flight (default 1024).

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "collision/bounds/problem_maker.h"
#include "collision/cpu/lanes/lane_scene.h"
#include "collision/exact/forest_cache.h"
#include "collision/gpu/gpu_pair_checker.h"
#include "collision/gpu/problem/gpu_kinematics.h"
#include "collision/gpu/recorded_verdicts.h"
#include "gpu_planning_scene/error.h"
#include "lanes/gl_device.h"
#include "shader_constants.h"
#include "support/test_scenes.h"

using namespace gpu_planning_scene::core;

namespace
{
const std::string kShaders = GPS_SOURCE_DIR "/shaders";
constexpr int kBatches = 3;

RobotProofs proofsOf(const RobotModel& robot, const std::shared_ptr<const CollisionProblem>& problem,
                     const ForestCache& forest)
{
  RobotProver prover;
  RobotProofs proofs;
  prover.prove(
      robot, *problem, forest.forest(), ProofCache(), [&](RobotProofs made) { proofs = std::move(made); },
      [] { return false; });
  return proofs;
}

void measure(const TestScene& scene, std::size_t states, Traversal traversal)
{
  const auto problem = std::make_shared<const CollisionProblem>(makeProblem(*scene.scene, "", nullptr));
  // Durations on a simulated device mean nothing, so they do not limit the parts.
  GpuPairChecker checker(kShaders, traversal, std::max<std::size_t>(states, 16384), {},
                         std::numeric_limits<double>::infinity());
  checker.setProblem(*problem);
  ForestCache forest;
  forest.exactCheckerOf(problem);
  const auto proofs = std::make_shared<const RobotProofs>(proofsOf(*scene.scene->robot, problem, forest));
  GpuKinematics kinematics(kShaders, scene.scene->robot);
  kinematics.setInstances(*problem);
  checker.useProofs(LaneScene(*scene.scene->robot, *problem, *forest.forest(), proofs,
                              gpu_planning_scene::core::lanes::kDeviceRounding),
                    kinematics);
  ::lanes::WorkCounts counts;
  std::vector<std::uint32_t> verdicts;
  for (int batch = 1; batch <= kBatches; ++batch)
  {
    const std::vector<double> values = scene.randomStates(states, static_cast<std::uint64_t>(batch));
    kinematics.setStates(values.data());
    if (batch == kBatches)
      ::lanes::device().countWork(&counts);
    RecordedVerdicts recorded(states);
    checker.check(kinematics, recorded, nullptr);
    verdicts = std::move(recorded.words);
  }
  ::lanes::device().countWork(nullptr);
  counts.print(std::cout);
  const auto undecided = std::count(verdicts.begin(), verdicts.end(), VERDICT_UNDECIDED);
  const GpuWork& work = checker.lastWork();
  std::cout << "\nstates\tundecided\tcandidates\troot pairs\ttraversed pairs\n"
            << work.states << '\t' << undecided << '\t' << work.candidates << '\t' << work.root_pairs << '\t'
            << work.traversed << std::endl;
}
}  // namespace

int main(int argc, char** argv)
{
  try
  {
    if (argc < 4)
      throw Error("usage: state_costs SCENE STATES TRAVERSAL [GROUPS]");
    setenv("GPU_PLANNING_SCENE_PROGRAM_CACHE", "off", 1);
    ::lanes::device().useExactArithmetic();
    ::lanes::device().setResidentGroups(argc > 4 ? std::stoul(argv[4]) : 1024);
    ::lanes::replaceOpenGl();
    measure(testScene(argv[1]), std::stoul(argv[2]), traversalFromName(argv[3]));
    for (const std::string& fault : ::lanes::device().faults())
      std::cerr << fault << std::endl;
    return ::lanes::device().faults().empty() ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  catch (const std::exception& error)
  {
    std::cerr << "state_costs: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
