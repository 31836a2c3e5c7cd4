// proof_agreement: compares the checkers that use proofs, on the CPU or on a device, with the exact checker alone, in
// many random states; see --help.

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <map>
#include <random>

#include "base/parallel_for.h"
#include "collision/bounds/problem_maker.h"
#include "collision/cpu/cpu_scene.h"
#include "collision/exact/forest_cache.h"
#include "command_line/command_line.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "support/test_scenes.h"

using namespace gpu_planning_scene::core;

namespace
{
constexpr std::size_t kBatch = 65536;
constexpr std::size_t kStatesPerChunk = 64;

CheckerOptions withoutProofs()
{
  CheckerOptions options;
  options.reductions.proofs = false;
  return options;
}

struct Counts
{
  std::size_t states = 0;
  std::size_t valid = 0;
  std::size_t false_free = 0;
  std::size_t false_collision = 0;
  std::size_t false_pair = 0;
  double seconds_exact = 0.0;
  double seconds_with_proofs = 0.0;
  std::size_t undecided = 0;  // on the device
};

std::unique_ptr<StateChecker> makeChecker(const std::shared_ptr<const PlanningScene>& scene, const std::string& device)
{
  if (device.empty())
    return std::make_unique<CpuChecker>(scene);
  BatchCheckerOptions options;
  options.device = device;
  options.device_only = true;
  return std::make_unique<BatchChecker>(scene, options);
}

/// The states for which there were proofs.
double statesWithProofs(const SceneReport& report)
{
  double all = 0.0;
  for (const DecidedStates& stage : report.decided)
    all += stage.by == "the exact checker alone" ? 0.0 : static_cast<double>(stage.states);
  return all;
}

/// Compares two checkers of one scene.
class Comparison
{
 public:
  Comparison(const TestScene& scene, const std::string& device, std::uint64_t seed)
    : scene_(scene),
      width_(scene.lower.size()),
      generator_(seed),
      exact_(scene.scene, withoutProofs()),
      with_proofs_(makeChecker(scene.scene, device)),
      problem_(std::make_shared<const CollisionProblem>(makeProblem(*scene.scene, "", nullptr))),
      pairs_checker_(ForestCache().exactCheckerOf(problem_)),
      pairs_(makePairs())
  {
    std::size_t checked = 0;
    while (checked <= kStatesBeforeProofs)
    {
      const std::vector<double> states = scene_.randomStates(kBatch, generator_());
      checked += with_proofs_->check(states.data(), kBatch).valid.size();
    }
    waitForProofs();
    with_proofs_->check(scene_.randomStates(kBatch, generator_()).data(), kBatch);
    if (device.empty() && statesWithProofs(with_proofs_->report()) == 0.0)
      throw Error("there are no proofs of scene " + scene.name + " to compare");
  }

  Counts next()
  {
    const std::vector<double> states = scene_.randomStates(kBatch, generator_());
    const BatchResult exact = exact_.check(states.data(), kBatch);
    const BatchResult proven = with_proofs_->check(states.data(), kBatch);
    Counts counts;
    counts.states = kBatch;
    counts.seconds_exact = exact.seconds;
    counts.seconds_with_proofs = proven.seconds;
    counts.undecided = proven.undecided_states;
    for (std::size_t i = 0; i < kBatch; ++i)
    {
      counts.valid += exact.valid[i];
      counts.false_free += proven.valid[i] && !exact.valid[i] ? 1 : 0;
      counts.false_collision += !proven.valid[i] && exact.valid[i] ? 1 : 0;
    }
    counts.false_pair = falsePairs(states, exact, proven);
    return counts;
  }

  SceneReport report() { return with_proofs_->report(); }

 private:
  /// Counts reported pairs that do not collide. Pairs that both checkers report need no check.
  std::size_t falsePairs(const std::vector<double>& states, const BatchResult& exact, const BatchResult& proven) const
  {
    std::atomic<std::size_t> count{0};
    const RobotModel& robot = *scene_.scene->robot;
    parallelFor(
        kBatch, kStatesPerChunk,
        [&, scratch = ExactChecker::Scratch(), poses = std::vector<Eigen::Isometry3d>(robot.links().size()),
         steps = std::vector<std::uint64_t>()](std::size_t begin, std::size_t end) mutable
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            if (proven.valid[i] || proven.colliding[i] == exact.colliding[i])
              continue;
            robot.linkPoses(&states[i * width_], poses.data());
            const auto pairs = pairs_.find(proven.colliding[i]);
            if (pairs == pairs_.end() || !pairs_checker_->firstCollisionOf(pairs->second.data(), pairs->second.size(),
                                                                           poses.data(), scratch, steps))
              ++count;
          }
        });
    return count;
  }

  /// The pairs of instances of each pair of bodies.
  std::map<BodyPair, std::vector<ExactChecker::OpenPair>> makePairs() const
  {
    std::map<BodyPair, std::vector<ExactChecker::OpenPair>> pairs;
    const auto add = [&](std::uint32_t a, std::size_t b)
    {
      const InstancePair instances = {a, static_cast<std::uint32_t>(b)};
      pairs[bodiesOf(*problem_, instances)].push_back({instances, 0.0});
    };
    const std::size_t robot = problem_->robot.size();
    const std::size_t world = problem_->world.size();
    const std::size_t half_spaces = problem_->half_spaces.size();
    for (const InstancePair& pair : problem_->self_pairs)
      add(pair[0], pair[1]);
    for (std::uint32_t i = 0; i < robot; ++i)
    {
      for (std::size_t k = 0; k < world; ++k)
        if (problem_->world_pairs[i * world + k] != 0)
          add(i, robot + k);
      for (std::size_t k = 0; k < half_spaces; ++k)
        if (problem_->half_space_pairs[i * half_spaces + k] != 0)
          add(i, robot + world + k);
    }
    return pairs;
  }

  const TestScene& scene_;
  std::size_t width_;
  std::mt19937_64 generator_;
  CpuChecker exact_;
  std::unique_ptr<StateChecker> with_proofs_;
  std::shared_ptr<const CollisionProblem> problem_;
  std::unique_ptr<const ExactChecker> pairs_checker_;
  std::map<BodyPair, std::vector<ExactChecker::OpenPair>> pairs_;
};

void add(const Counts& part, Counts& all)
{
  all.states += part.states;
  all.valid += part.valid;
  all.false_free += part.false_free;
  all.false_collision += part.false_collision;
  all.false_pair += part.false_pair;
  all.undecided += part.undecided;
  all.seconds_exact += part.seconds_exact;
  all.seconds_with_proofs += part.seconds_with_proofs;
}

/// The share of states that needed an exact test of some pair, of the states for which there were proofs.
double shareOfExactTests(const SceneReport& report)
{
  double exact = 0.0;
  for (const DecidedStates& stage : report.decided)
    exact += stage.by == "exact tests of the other pairs" ? static_cast<double>(stage.states) : 0.0;
  return exact / statesWithProofs(report);
}

void print(const std::string& name, const Counts& counts, double exact_share)
{
  const auto states = static_cast<double>(counts.states);
  std::printf("| %s | %zu | %.1f %% | %.1f %% | %zu | %zu | %zu | %.2f |\n", name.c_str(), counts.states,
              100.0 * static_cast<double>(counts.valid) / states, 100.0 * (1.0 - exact_share), counts.false_free,
              counts.false_collision, counts.false_pair, counts.seconds_exact / counts.seconds_with_proofs);
  std::fflush(stdout);
}

void run(const CommandLine& arguments)
{
  const std::string only = arguments.value("--scene", "");
  const std::string device = arguments.value("--device", "");
  const auto seed = static_cast<std::uint64_t>(arguments.integer("--seed", 1, 0, 1LL << 62));
  const auto states = static_cast<std::size_t>(arguments.integer("--states", 1'000'000, 1, 1LL << 40));
  const std::vector<std::string>& names = benchmarkSceneNames();
  if (!only.empty() && std::find(names.begin(), names.end(), only) == names.end())
    throw UsageError("there is no scene '" + only + "'");
  std::printf(
      "seed %llu\n\n| scene | states | valid | decided without an exact test | false free | false collision | "
      "false pair | times as fast |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n",
      static_cast<unsigned long long>(seed));
  Counts total;
  for (const std::string& name : names)
  {
    if (!only.empty() && name != only)
      continue;
    if (const std::string missing = missingFor(name); !missing.empty())
    {
      std::printf("%s is left out: there is no %s\n", name.c_str(), missing.c_str());
      continue;
    }
    Comparison comparison(testScene(name), device, seed);
    Counts counts;
    while (counts.states < states)
      add(comparison.next(), counts);
    print(name, counts,
          device.empty() ? shareOfExactTests(comparison.report())
                         : static_cast<double>(counts.undecided) / static_cast<double>(counts.states));
    add(counts, total);
  }
  std::printf("\n%zu states, %zu wrong answers\n", total.states,
              total.false_free + total.false_collision + total.false_pair);
  if (total.false_free + total.false_collision + total.false_pair > 0)
    throw Error("there are wrong answers");
}
}  // namespace

int main(int argc, char** argv)
{
  const Tool tool{"proof_agreement",
                  "[--states N] [--scene NAME] [--device D] [--seed S]",
                  "Compares the verdicts of the CPU checker that uses proofs (balls and tables of joint values), or of "
                  "a device that\n"
                  "uses them, with those of the exact checker alone, in random states of each scene of benchmark. Also "
                  "checks that each reported pair of "
                  "bodies\n"
                  "collides. Prints a Markdown table.\n"
                  "Exit code: 0 no wrong answer, 1 a wrong answer or another error, 2 bad usage.",
                  {{"--states", "N", "at least N states per scene (default 1000000)"},
                   {"--scene", "NAME", "only this scene"},
                   {"--device", "D",
                    "the device: auto, software, an index, or part of a renderer's name (default: the CPU checker)"},
                   {"--seed", "S", "seed of the random states (default 1)"}},
                  run};
  return runTool(tool, argc, argv);
}
