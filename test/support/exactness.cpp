#include "support/exactness.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "base/parallel_for.h"
#include "base/seconds_since.h"
#include "collision/bounds/problem_maker.h"
#include "collision/cpu/cpu_scene.h"
#include "collision/problem/collision_problem.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::core
{
namespace
{
using oracle::Verdict;

constexpr std::size_t kFailuresKept = 5;
constexpr double kLargestClearance = 1e-2;  // metres: larger clearances are not measured

std::shared_ptr<const CollisionProblem> problemOf(const TestScene& scene)
{
  return std::make_shared<const CollisionProblem>(makeProblem(*scene.scene, "", nullptr));
}

std::unique_ptr<BatchChecker> batchChecker(const TestScene& scene, Traversal traversal, const std::string& device)
{
  BatchCheckerOptions options;
  options.device = device;
  options.traversal = traversal;
  options.device_only = true;
  return std::make_unique<BatchChecker>(scene.scene, options);
}

CheckerOptions withoutProofs()
{
  CheckerOptions options;
  options.reductions.proofs = false;
  return options;
}

/// A checker whose proofs are made.
std::unique_ptr<CpuChecker> proven(const TestScene& scene)
{
  auto checker = std::make_unique<CpuChecker>(scene.scene);
  const std::vector<double> states = scene.randomStates(kStatesBeforeProofs + 1, 1);
  checker->check(states.data(), kStatesBeforeProofs + 1);
  waitForProofs();
  return checker;
}

/// The states that were decided without an exact test.
std::size_t provenStates(const SceneReport& report)
{
  std::size_t count = 0;
  for (const DecidedStates& stage : report.decided)
    count += stage.by.rfind("exact tests", 0) == 0 || stage.by.rfind("the exact", 0) == 0 ? 0 : stage.states;
  return count;
}

BodyPair sorted(std::int32_t a, std::int32_t b)
{
  return {std::min(a, b), std::max(a, b)};
}

std::string describe(const double* state, std::size_t width)
{
  std::string text;
  char number[32];
  for (std::size_t v = 0; v < width; ++v)
  {
    std::snprintf(number, sizeof number, "%s%.17g", v == 0 ? "" : ", ", state[v]);
    text += number;
  }
  return "[" + text + "]";
}

std::size_t decadeOf(double clearance)
{
  std::size_t decade = 0;
  for (double bound = 1e-9; decade < 7 && clearance >= bound; bound *= 10.0)
    ++decade;
  return decade;
}
}  // namespace

ExactnessCheck::ExactnessCheck(const TestScene& scene, bool with_proofs, const std::string& device)
  : scene_(scene),
    oracle_(problemOf(scene)),
    cpu_(scene.scene, withoutProofs()),
    with_proofs_(with_proofs ? proven(scene) : nullptr),
    work_queue_(batchChecker(scene, Traversal::WorkQueue, device)),
    breadth_first_(batchChecker(scene, Traversal::BreadthFirst, device))
{
  const auto problem = problemOf(scene);
  const std::size_t robot = problem->robot.size();
  const std::size_t world = problem->world.size();
  const std::size_t planes = problem->half_spaces.size();
  for (const auto& [a, b] : problem->self_pairs)
    checked_[sorted(problem->robot[a].body, problem->robot[b].body)].push_back({a, b});
  for (std::size_t i = 0; i < robot; ++i)
  {
    for (std::size_t k = 0; k < world; ++k)
      if (problem->world_pairs[i * world + k])
        checked_[sorted(problem->robot[i].body, problem->world[k].body)].push_back({i, robot + k});
    for (std::size_t k = 0; k < planes; ++k)
      if (problem->half_space_pairs[i * planes + k])
        checked_[sorted(problem->robot[i].body, problem->half_spaces[k].body)].push_back({i, robot + world + k});
  }
}

Verdict ExactnessCheck::pairVerdict(const std::vector<oracle::Motion>& poses, BodyPair pair) const
{
  Verdict worst = Verdict::Free;
  const auto found = checked_.find(sorted(pair[0], pair[1]));
  if (found == checked_.end())
    return worst;
  for (const auto& [first, second] : found->second)
  {
    const Verdict verdict = oracle_.pairVerdict(poses, first, second);
    if (verdict == Verdict::Collides)
      return verdict;
    if (verdict == Verdict::Either)
      worst = verdict;
  }
  return worst;
}

/// A reported pair that collides decides the state's verdict. The oracle then need not check the other pairs.
ExactnessCheck::Judgement ExactnessCheck::judge(const double* state, const std::vector<BodyPair>& reported,
                                                bool clearance) const
{
  const std::vector<oracle::Motion> poses = oracle::linkPoses(*scene_.scene->robot, state);
  Judgement judgement{Verdict::Free, false, 0.0};
  for (const BodyPair& pair : reported)
  {
    const Verdict verdict = pairVerdict(poses, pair);
    judgement.false_pair = judgement.false_pair || verdict == Verdict::Free;
    if (verdict == Verdict::Collides)
      judgement.verdict = verdict;
  }
  if (judgement.verdict != Verdict::Collides)
    judgement.verdict = oracle_.verdict(poses);
  if (clearance && judgement.verdict != Verdict::Collides)
    judgement.clearance = oracle_.clearance(poses, kLargestClearance);
  return judgement;
}

/// Calls of 1, 7, 64 and 1024 states. The small batch sizes check only part of the states, to take about a second each.
void ExactnessCheck::compareSizes(StateChecker& checker, const std::string& name, const std::vector<double>& states,
                                  const std::vector<std::uint8_t>& expected, Exactness& exactness) const
{
  const std::size_t width = scene_.lower.size();
  for (const auto& [size, max_count] :
       {std::pair<std::size_t, std::size_t>{1, 50}, {7, 350}, {64, 2000}, {1024, 20480}})
  {
    const std::size_t count = std::min(max_count, expected.size());
    for (std::size_t begin = 0; begin < count; begin += size)
    {
      const std::size_t part = std::min(size, count - begin);
      const BatchResult result = checker.check(&states[begin * width], part);
      for (std::size_t i = 0; i < part; ++i)
      {
        if (result.valid[i] == expected[begin + i])
          continue;
        ++exactness.disagreeing;
        if (exactness.failures.size() < kFailuresKept)
          exactness.failures.push_back(name + " in calls of " + std::to_string(size) +
                                       " states is not the CPU's: " + describe(&states[(begin + i) * width], width));
      }
    }
  }
}

Exactness ExactnessCheck::compare(const std::vector<double>& states, bool clearances, const std::string& label)
{
  const std::size_t width = scene_.lower.size();
  const std::size_t count = states.size() / width;
  Exactness exactness;
  exactness.states = count;
  const BatchResult on_cpu = cpu_.check(states.data(), count);
  std::vector<BatchResult> results = {on_cpu};
  const auto add = [&](BatchChecker& checker, const char* name, std::size_t& undecided)
  {
    checker.check(states.data(), count);  // the first call includes one-time work, which is not timed
    results.push_back(checker.check(states.data(), count));
    undecided = results.back().undecided_states;
    compareSizes(checker, name, states, on_cpu.valid, exactness);
  };
  if (with_proofs_)
  {
    const std::size_t before = provenStates(with_proofs_->report());
    results.push_back(with_proofs_->check(states.data(), count));
    exactness.proven = provenStates(with_proofs_->report()) - before;
    compareSizes(*with_proofs_, "with proofs", states, on_cpu.valid, exactness);
  }
  add(*work_queue_, "work_queue", exactness.undecided_work_queue);
  add(*breadth_first_, "breadth_first", exactness.undecided_breadth_first);

  const auto start = std::chrono::steady_clock::now();
  std::vector<Judgement> judgements(count);
  constexpr std::size_t kStatesAtOnce = 256;
  ProgressBar progress(label, count);
  for (std::size_t begin = 0; begin < count; begin += kStatesAtOnce)
  {
    parallelFor(std::min(kStatesAtOnce, count - begin), 4,
                [&](std::size_t from, std::size_t to)
                {
                  for (std::size_t i = begin + from; i < begin + to; ++i)
                  {
                    std::vector<BodyPair> reported;
                    for (const BatchResult& result : results)
                      if (!result.valid[i] &&
                          std::find(reported.begin(), reported.end(), result.colliding[i]) == reported.end())
                        reported.push_back(result.colliding[i]);
                    judgements[i] = judge(&states[i * width], reported, clearances);
                  }
                });
    progress.update(begin);
  }
  exactness.oracle_seconds = secondsSince(start);

  for (std::size_t i = 0; i < count; ++i)
  {
    const Judgement& judgement = judgements[i];
    const auto fail = [&](const std::string& what)
    {
      if (exactness.failures.size() < kFailuresKept)
        exactness.failures.push_back(what + ": " + describe(&states[i * width], width));
    };
    exactness.valid += on_cpu.valid[i];
    exactness.either += judgement.verdict == Verdict::Either ? 1 : 0;
    if (clearances && judgement.verdict != Verdict::Collides)
      ++exactness.clearances[decadeOf(judgement.clearance)];
    if (judgement.false_pair && ++exactness.false_pair)
      fail("a pair that does not collide");
    for (std::size_t method = 0; method < results.size(); ++method)
    {
      const bool valid = results[method].valid[i] != 0;
      if (valid && judgement.verdict == Verdict::Collides && ++exactness.false_free)
        fail("free, but collides");
      if (!valid && judgement.verdict == Verdict::Free && ++exactness.false_collision)
        fail("collision, but free");
      if (results[method].valid[i] != on_cpu.valid[i] && ++exactness.disagreeing)
        fail("not the CPU's verdict");
    }
  }
  return exactness;
}
}  // namespace gpu_planning_scene::core
