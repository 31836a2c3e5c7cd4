// distances: compares the distances of bodies with the oracle, and their speed with FCL's; see --help.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>

#include "base/parallel_for.h"
#include "base/seconds_since.h"
#include "collision/bounds/problem_maker.h"
#include "command_line/command_line.h"
#include "support/distance_truth.h"
#include "support/fcl_peer.h"
#include "support/test_scenes.h"

using namespace gpu_planning_scene::core;

namespace
{
const std::vector<std::string> kScenes = {"arm_boxes", "kr5", "wam", "ur5_table_pick", "panda_boxes", "drchubo"};
constexpr double kLargestDistanceError = 1.1e-6;  // metres
constexpr double kLargestPointError = 4e-6;       // metres
constexpr double kLargestSlopeError = 1e-3;       // metres per radian or metre

/// Compares all pairs in the range, and the gradient of one free pair per state.
bool compareWithOracle(const TestScene& scene, std::size_t count, double range, std::uint64_t seed)
{
  const std::size_t width = scene.scene->robot->variables().size();
  const std::vector<double> states = scene.randomStates(count, seed);
  const StateInspector inspector(scene.scene);
  const BodyDistances found = inspector.distances(states.data(), count, "", {range, false, true});
  const DistanceTruth truth(scene.scene, "");
  std::mutex mutex;
  DistanceFaults faults;
  std::size_t gradients = 0;
  double slope_error = 0.0;
  parallelFor(count, 1,
              [&](std::size_t i, std::size_t)
              {
                const double* state = &states[i * width];
                const DistanceFaults of_state = truth.compareAllPairs(state, found, i, range);
                double error = 0.0;
                const std::size_t pairs = found.first[i + 1] - found.first[i];
                const std::size_t k = found.first[i] + (pairs == 0 ? 0 : i % pairs);
                const bool has_gradient = pairs != 0 && found.pairs[k].distance > 0.0;
                if (has_gradient)
                  error = truth.gradientError(state, found.pairs[k], &found.gradients[k * width]);
                const std::lock_guard<std::mutex> lock(mutex);
                faults += of_state;
                gradients += has_gradient ? 1 : 0;
                slope_error = std::isnan(error) ? error : std::max(error, slope_error);
              });
  std::printf("| %s | %zu | %zu | %zu | %zu | %zu | %.2g | %.2g | %zu | %.2g |\n", scene.name.c_str(), count,
              faults.compared, faults.colliding, faults.missing, faults.invented, faults.distance_error,
              faults.point_error, gradients, slope_error);
  std::fflush(stdout);
  return faults.missing == 0 && faults.invented == 0 && faults.distance_error <= kLargestDistanceError &&
         faults.point_error <= kLargestPointError && slope_error <= kLargestSlopeError;
}

/// States per second of `work(states, count)`, which is given as many states as it computes in a second.
template <class Work>
double rateOf(const Work& work)
{
  for (std::size_t count = 1;; count *= 4)
  {
    const auto begin = std::chrono::steady_clock::now();
    work(count);
    const double seconds = secondsSince(begin);
    if (seconds > 1.0)
      return static_cast<double>(count) / seconds;
  }
}

void compareWithFcl(const TestScene& scene, double range, std::uint64_t seed, int repeats)
{
  constexpr std::size_t kMost = 1 << 18;
  const RobotModel& robot = *scene.scene->robot;
  const std::size_t width = robot.variables().size();
  const std::vector<double> states = scene.randomStates(kMost, seed);
  const StateInspector inspector(scene.scene);
  const FclPeer fcl(
      std::make_shared<const CollisionProblem>(ProblemMaker(optionsWithAllPairs()).make(*scene.scene, "", nullptr)));
  for (int i = 0; i < repeats; ++i)
  {
    const double fcls = rateOf(
        [&](std::size_t count)
        {
          parallelFor(
              count, 1,
              [&, peer = fcl, poses = std::vector<Eigen::Isometry3d>(robot.links().size())](std::size_t k,
                                                                                            std::size_t) mutable
              {
                robot.linkPoses(&states[k % kMost * width], poses.data());
                peer.setState(poses.data());
                peer.distances();
              });
        });
    const auto ours = [&](const DistanceQuery& query)
    {
      return rateOf(
          [&](std::size_t count)
          {
            for (std::size_t done = 0; done < count; done += kMost)
              inspector.distances(states.data(), std::min(count - done, kMost), "", query);
          });
    };
    constexpr double kAny = std::numeric_limits<double>::infinity();
    std::printf("| %s | %.0f |", scene.name.c_str(), fcls);
    for (const DistanceQuery& query : {DistanceQuery{kAny, true, true, false}, DistanceQuery{kAny, true, true, true},
                                       DistanceQuery{range, false, true, true}, DistanceQuery{kAny, false, true, true}})
    {
      const double rate = ours(query);
      std::printf(" %.0f, %.1f |", rate, rate / fcls);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}

void run(const CommandLine& arguments)
{
  const auto seed = arguments.count("--seed", 1, 0, 1ULL << 62);
  const auto states = arguments.count("--states", 1000, 1, 100000000);
  const double range = arguments.number("--range", 0.1, 1e-3, 10.0);
  const std::string only = arguments.value("--scene", "");
  const bool rates = arguments.has("--rates");
  if (rates)
    std::printf(
        "States/s, and as multiples of FCL's:\n\n"
        "| scene | FCL, all pairs | nearest of each body, without depths | nearest of each body | pairs within %g m | "
        "all pairs |\n| --- | --- | --- | --- | --- | --- |\n",
        range);
  else
    std::printf(
        "| scene | states | pairs within %g m | colliding | missing | invented | distance error, m | point "
        "error, m | gradients | slope error |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        range);
  bool good = true;
  for (const std::string& name : kScenes)
  {
    if (!only.empty() && name != only)
      continue;
    if (const std::string missing = missingFor(name); !missing.empty())
      throw Error("scene " + name + " needs " + missing);
    if (rates)
      compareWithFcl(testScene(name), range, seed, 3);
    else
      good = compareWithOracle(testScene(name), states, range, seed) && good;
  }
  if (!good)
    throw Error("there are wrong distances");
}
}  // namespace

int main(int argc, char** argv)
{
  const Tool tool{"distances",
                  "[--states N] [--range R] [--scene NAME] [--seed S] [--rates]",
                  "Compares the distances of all pairs of bodies within a range, in random states of robots among\n"
                  "obstacles, with an oracle in quadruple precision, and the gradient of one pair per state with the\n"
                  "oracle's slopes. Prints a Markdown table. Exit code: 0 no wrong distance, 1 a wrong distance or\n"
                  "another error, 2 bad usage.",
                  {{"--states", "N", "states of each scene (default 1000)"},
                   {"--range", "R", "metres (default 0.1)"},
                   {"--scene", "NAME", "only this scene"},
                   {"--seed", "S", "seed of the random states (default 1)"},
                   {"--rates", "", "compares the speed with FCL's distances of all pairs, on all cores, three times"}},
                  run};
  return runTool(tool, argc, argv);
}
