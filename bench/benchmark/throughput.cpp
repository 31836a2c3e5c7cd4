// States per second and wrong answers of every method on every scene. The methods take turns within a repeat, so a
// change of the machine's speed affects all methods. A ratio is the median of the ratios within each repeat.

#include <algorithm>
#include <iostream>
#include <limits>
#include <optional>

#include "base/parallel_for.h"
#include "benchmark/csv_table.h"
#include "benchmark/geometric_error.h"
#include "benchmark/settings.h"
#include "benchmark/state_kinds.h"
#include "benchmark/statistics.h"
#include "benchmark/truth.h"
#include "collision/cpu/cpu_scene.h"
#include "collision/proofs/proof_worker.h"
#include "support/test_scenes.h"
#include "tools/progress_bar.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr std::size_t kTrial = 4;             // states of the first trial
constexpr std::size_t kWorkStates = 4096;     // upper bound on the states whose work is counted
constexpr std::size_t kManyStates = 4096;     // from this number of states on, proofs are made before the timing
constexpr std::size_t kErrorsMeasured = 100;  // upper bound, for each kind of wrong answer of a method

/// A method with one batch size.
struct Run
{
  const MethodInfo* info;
  std::shared_ptr<Method> method;
  std::size_t batch;  // 0: all at once
  std::size_t count = 0;
  std::size_t undecided = 0;
  std::size_t wrong_timed = 0;  // wrong answers in timed repeats, if the method claims to be exact
  std::vector<std::uint8_t> answers = {};
  std::vector<double> rates = {};
  std::vector<double> cpu = {};
};

/// The states of one row of the tables.
struct Batch
{
  const TestScene* scene;
  std::string kind;
  double padding;
  std::vector<double> states;
  std::vector<std::uint8_t> truth;
  std::vector<std::uint8_t> open;  // 1: so near to contact that the contract accepts both answers of a peer
};

std::vector<Run> makeRuns(const TestScene& scene, double padding, const Settings& settings)
{
  std::vector<Run> runs;
  for (const MethodInfo& info : settings.methods)
  {
    if (padding > 0.0 && !info.paddable)
      continue;
    if (const std::string reason = info.refuses ? info.refuses(*scene.scene) : ""; !reason.empty())
    {
      std::cerr << scene.name << ": " << info.name << " is left out: " << reason << '\n';
      continue;
    }
    const std::shared_ptr<Method> method = info.make(scene.scene, settings.method);
    if (!info.batched)
      runs.push_back({&info, method, 0});
    else
      for (const std::size_t batch : settings.batches)
        runs.push_back({&info, method, batch});
  }
  return runs;
}

/// Checks all states in pieces of the run's batch size.
std::vector<std::uint8_t> checkAll(Run& run, const Batch& batch)
{
  const std::size_t width = batch.scene->lower.size();
  const std::size_t piece = run.batch == 0 ? run.count : run.batch;
  std::vector<std::uint8_t> answers;
  run.undecided = 0;
  for (std::size_t begin = 0; begin < run.count; begin += piece)
  {
    const auto part = run.method->check(&batch.states[begin * width], std::min(piece, run.count - begin));
    answers.insert(answers.end(), part.begin(), part.end());
    run.undecided += run.method->undecided();
  }
  return answers;
}

/// Number of states that a method can check in the given time, found by trials with growing numbers of states. A run
/// with a batch size always gets all states, because a smaller batch would be a different measurement.
std::size_t affordableStates(const Run& run, const Batch& batch, const Settings& settings)
{
  const std::size_t all = batch.truth.size();
  if (run.batch != 0)
    return all;
  for (std::size_t trial = std::min(kTrial, all);; trial = std::min(4 * trial, all))
  {
    const double seconds = secondsOf([&] { run.method->check(batch.states.data(), trial); });
    if (trial == all || seconds > settings.seconds)
      return trial;
    if (const double share = settings.seconds / seconds; share < 4.0)
      return std::min(all, static_cast<std::size_t>(share * static_cast<double>(trial)));
  }
}

/// Runs one-time work (compiling, learning) before the timing. Then records the answers.
void warmUp(Run& run, const Batch& batch, const Settings& settings)
{
  run.method->check(batch.states.data(), std::min(kTrial, batch.truth.size()));
  run.count = affordableStates(run, batch, settings);
  run.wrong_timed = 0;
  run.rates.clear();
  run.cpu.clear();
  run.answers = checkAll(run, batch);
  if (!run.info->exact || run.count < kManyStates)
    return waitForProofs();
  for (std::size_t checked = 0; checked <= kStatesBeforeProofs; checked += run.count)
    run.method->check(batch.states.data(), run.count);
  run.method->check(batch.states.data(), run.count);  // asks for the proofs
  waitForProofs();
  run.method->check(batch.states.data(), run.count);  // chooses between CPU and GPU anew
}

/// NaN if the method `name` was not measured.
double ratioTo(const char* name, const Run& run, const std::vector<Run>& runs)
{
  const auto reference =
      std::find_if(runs.begin(), runs.end(), [&](const Run& other) { return other.info->name == name; });
  std::vector<double> ratios;
  for (std::size_t i = 0; reference != runs.end() && i < run.rates.size(); ++i)
    ratios.push_back(run.rates[i] / reference->rates[i]);
  return median(ratios);
}

/// Empty for a method in which devices and cores do not work together.
Cell deviceShare(Method& method)
{
  const std::optional<double> share = method.deviceShare();
  return share ? Cell(*share) : Cell("");
}

class Tables
{
 public:
  explicit Tables(const std::string& folder)
    : throughput_(folder, "throughput.csv",
                  {"scene",
                   "robot",
                   "triangles",
                   "objects",
                   "kind",
                   "padding_m",
                   "valid_share",
                   "method",
                   "title",
                   "family",
                   "batch",
                   "states",
                   "repeats",
                   "states_per_s",
                   "states_per_s_min",
                   "states_per_s_max",
                   "of_fcl_obbrss",
                   "cpu_us_a_state",
                   "undecided_share",
                   "of_fcl_ordered",
                   "device_share",
                   "node_visits_a_state",
                   "candidates_a_state",
                   "root_pairs_a_state",
                   "traversed_a_state"}),
      accuracy_(folder, "accuracy.csv",
                {"scene", "kind", "padding_m", "method", "title", "family", "claims_exact", "states", "open",
                 "wrong_free", "wrong_collision", "wrong_per_million", "measured", "largest_clearance_m",
                 "largest_depth_m", "largest_error_m", "batch"})
  {
  }

  /// `runs`: all runs of the batch.
  void addThroughput(const Batch& batch, const Run& run, const std::vector<Run>& runs)
  {
    const PlanningScene& scene = *batch.scene->scene;
    const auto [least, most] = std::minmax_element(run.rates.begin(), run.rates.end());
    const std::size_t batch_size = run.batch == 0 ? run.count : run.batch;
    const WorkPerState work = run.method->work(batch.states.data(), std::min({run.count, batch_size, kWorkStates}));
    throughput_.add({batch.scene->name,
                     scene.robot->name(),
                     scene.robot->triangleCount(),
                     scene.objects.size(),
                     batch.kind,
                     batch.padding,
                     validShare(batch.truth),
                     run.info->name,
                     run.info->title,
                     run.info->family,
                     batch_size,
                     run.count,
                     run.rates.size(),
                     median(run.rates),
                     *least,
                     *most,
                     ratioTo(kReferenceMethod, run, runs),
                     median(run.cpu),
                     static_cast<double>(run.undecided) / static_cast<double>(run.count),
                     ratioTo(kOrderedMethod, run, runs),
                     deviceShare(*run.method),
                     work.node_visits,
                     work.candidates,
                     work.root_pairs,
                     work.traversed});
  }

  /// Returns the number of wrong answers.
  std::size_t addAccuracy(const Batch& batch, const Run& run, GeometricError& error)
  {
    std::vector<std::size_t> wrong_free;
    std::vector<std::size_t> wrong_collision;
    std::size_t open = 0;
    for (std::size_t i = 0; i < run.count; ++i)
    {
      open += batch.open[i];
      // Near contact the contract accepts both answers, but all methods of the project must give the same answer.
      if (run.answers[i] != batch.truth[i] && (run.info->exact || batch.open[i] == 0))
        (run.answers[i] != 0 ? wrong_free : wrong_collision).push_back(i);
    }
    std::size_t measured = 0;
    const auto largest = [&](const std::vector<std::size_t>& wrong, const auto& size)
    {
      double most = 0.0;
      const std::size_t count = std::min(wrong.size(), kErrorsMeasured);
      for (std::size_t i = 0; i < count; ++i, ++measured)
        most = std::max(most, size(&batch.states[wrong[i * wrong.size() / count] * batch.scene->lower.size()]));
      return most;
    };
    const double clearance = largest(
        wrong_collision, [&](const double* state) { return error.clearance(state); });
    const double depth = largest(wrong_free, [&](const double* state) { return error.depth(state); });
    const std::size_t wrong = wrong_free.size() + wrong_collision.size();
    accuracy_.add({batch.scene->name, batch.kind, batch.padding, run.info->name, run.info->title, run.info->family,
                   run.info->exact ? "yes" : "no", run.count, open, wrong_free.size(), wrong_collision.size(),
                   1e6 * static_cast<double>(wrong) / static_cast<double>(run.count), measured, clearance, depth,
                   std::max(clearance, depth), run.batch == 0 ? run.count : run.batch});
    return wrong;
  }

 private:
  CsvTable throughput_;
  CsvTable accuracy_;
};

/// Flags states for which the contract accepts both answers. Random states are never so near to contact.
std::vector<std::uint8_t> openStates(const Batch& batch, const GeometricError& error)
{
  std::vector<std::uint8_t> open(batch.truth.size());
  if (batch.kind == "near_contact")
    parallelFor(open.size(), 16,
                [&, own = error](std::size_t begin, std::size_t end) mutable
                {
                  for (std::size_t i = begin; i < end; ++i)
                    open[i] = own.isOpen(&batch.states[i * batch.scene->lower.size()], batch.truth[i] != 0) ? 1 : 0;
                });
  return open;
}

/// Returns the number of wrong answers of methods that claim to be exact.
std::size_t measureBatch(const Batch& batch, std::vector<Run>& runs, GeometricError& error, const Settings& settings,
                         Tables& tables)
{
  const std::string label = batch.scene->name + ", " + batch.kind + (batch.padding > 0.0 ? ", padded" : "");
  ProgressBar progress(label, runs.size() * (settings.repeats + 2));
  std::size_t done = 0;
  for (Run& run : runs)
  {
    progress.update(done++);
    warmUp(run, batch, settings);
  }
  for (std::size_t repeat = 0; repeat < settings.repeats; ++repeat)
    for (Run& run : runs)
    {
      progress.update(done++);
      const Stopwatch watch;
      const std::vector<std::uint8_t> answers = checkAll(run, batch);
      run.rates.push_back(static_cast<double>(run.count) / watch.seconds());
      run.cpu.push_back(1e6 * watch.cpuSeconds() / static_cast<double>(run.count));
      run.wrong_timed += wrongAnswers(*run.info, answers, batch.truth);
    }
  std::size_t wrong = 0;
  for (const Run& run : runs)
  {
    progress.update(done++);
    tables.addThroughput(batch, run, runs);
    const std::size_t of_this = tables.addAccuracy(batch, run, error);
    if (run.info->exact)
      wrong +=
          reportWrongAnswers(label + ", batches of " + std::to_string(run.batch), *run.info, of_this + run.wrong_timed);
  }
  return wrong;
}
}  // namespace

std::size_t measureThroughput(const Settings& settings)
{
  Tables tables(settings.out);
  std::size_t wrong = 0;
  for (const std::string& name : settings.scenes)
    for (const double padding : settings.paddings)
    {
      const TestScene scene = padding > 0.0 ? withPadding(testScene(name), padding) : testScene(name);
      std::vector<Run> runs = makeRuns(scene, padding, settings);
      if (runs.empty())
        continue;
      GeometricError error(*scene.scene);
      Truth exact(scene.scene);
      for (const std::string& kind : settings.kinds)
      {
        if (padding != settings.paddings.front() && kind != "random")
          continue;
        Batch batch{&scene, kind, padding, makeStates(scene, kind, settings.states, settings.seed), {}, {}};
        batch.truth = exact.check(batch.states.data(), settings.states);
        batch.open = openStates(batch, error);
        wrong += measureBatch(batch, runs, error, settings, tables);
      }
      std::cerr << name << (padding > 0.0 ? ", padded" : "") << ": measured" << std::endl;
    }
  return wrong;
}
}  // namespace gpu_planning_scene::core::benchmark
