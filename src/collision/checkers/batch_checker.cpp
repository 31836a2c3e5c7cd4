#include "gpu_planning_scene/batch_checker.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "collision/batch_size.h"
#include "collision/checkers/cpu_or_gpu.h"
#include "collision/checkers/cpu_scene.h"
#include "collision/gpu/gpu_checker.h"
#include "collision/problem/state_validation.h"
#include "collision/rows_without.h"
#include "model/seconds_since.h"

namespace gpu_planning_scene::core
{
struct BatchChecker::Impl
{
  explicit Impl(const BatchCheckerOptions& options)
    : cpu_or_gpu(options.cpu_below), on_cpu(options), gpu_checker(options, on_cpu.trees())
  {
  }

  std::size_t width() const { return on_cpu.scene()->robot->variables().size(); }
  bool areOrdinary(const double* states, std::size_t count, const std::string& group);
  void checkOnGpu(const double* states, std::size_t count, const std::string& group, BatchResult& result,
                  const Margins* margins, bool ordinary);
  void checkStates(const double* states, std::size_t count, const std::string& group, bool ordinary,
                   BatchResult& result);
  void checkAround(const double* states, std::size_t count, const std::string& group, const Margins& margins,
                   bool ordinary, BatchResult& result);
  BatchResult timedCheck(const double* states, std::size_t count, const std::string& group,
                         const JointNeighbourhood* around, bool ordinary);
  CpuOrGpu::Choice choose(const std::string& group, const double* states, std::size_t count);

  std::mutex mutex;
  CpuOrGpu cpu_or_gpu;
  CpuScene on_cpu;
  GpuChecker gpu_checker;
  GpuWork work;                               // work of the last batch
  std::optional<std::string> selected_group;  // group whose pairs the GPU checker holds
};

/// Whether all states pass three tests: their values are allowed, the group's problem is valid for them, and the device
/// can place them. If this is true, one pass over a large request replaces three passes, whose time would be the time
/// to read the memory. False proves nothing.
bool BatchChecker::Impl::areOrdinary(const double* states, std::size_t count, const std::string& group)
{
  std::vector<double> upper = gpu_checker.largestValues();
  if (upper.size() != width())
    return false;
  for (std::size_t i = 0; i < upper.size(); ++i)
    upper[i] = std::min(upper[i], on_cpu.scene()->robot->variables()[i].largest);
  std::vector<double> lower(upper.size());
  std::transform(upper.begin(), upper.end(), lower.begin(), std::negate<>());
  for (const VariableRange& range : on_cpu.problem(group)->ranges)
  {
    const auto variable = static_cast<std::size_t>(range.variable);
    lower[variable] = std::max(lower[variable], range.lower);
    upper[variable] = std::min(upper[variable], range.upper);
  }
  const auto is_ordinary = [&](std::size_t row)
  {
    const double* const state = states + row * upper.size();
    bool within = true;
    for (std::size_t i = 0; i < upper.size(); ++i)
      within &= state[i] >= lower[i] && state[i] <= upper[i];
    return within;
  };
  return rowsWithout(count, is_ordinary).empty();
}

/// The group's problem must be valid for the states. `ordinary`: see areOrdinary.
void BatchChecker::Impl::checkOnGpu(const double* states, std::size_t count, const std::string& group,
                                    BatchResult& result, const Margins* margins, bool ordinary)
{
  if (selected_group != group)
  {
    const auto& problem = on_cpu.problem(group);
    selected_group.reset();  // in case selectPairs throws: the GPU checker's pairs are then unknown
    gpu_checker.selectPairs(problem);
    selected_group = group;
  }
  gpu_checker.useProofs(on_cpu.proofs(group));
  gpu_checker.check(states, count, result, margins, ordinary);
  work = gpu_checker.lastWork();
}

/// Sends the states for which the group's problem is not valid to the CPU; only the CPU can decide them.
void BatchChecker::Impl::checkStates(const double* states, std::size_t count, const std::string& group, bool ordinary,
                                     BatchResult& result)
{
  if (ordinary)
    return checkOnGpu(states, count, group, result, nullptr, true);
  const CollisionProblem& problem = *on_cpu.problem(group);
  std::vector<std::size_t> rows[2];  // [0]: states for the GPU, [1]: states for the CPU
  rows[1] = rowsWithout(count, [&](std::size_t row) { return isValidFor(problem, states + row * width()); });
  if (rows[1].empty())
    return checkOnGpu(states, count, group, result, nullptr, false);
  for (std::size_t row = 0, next = 0; row < count; ++row)
    if (next < rows[1].size() && rows[1][next] == row)
      ++next;
    else
      rows[0].push_back(row);
  result.valid.resize(count);
  result.colliding.resize(count);
  for (const auto& part : rows)
  {
    std::vector<double> values;
    for (const std::size_t row : part)
      values.insert(values.end(), states + row * width(), states + (row + 1) * width());
    BatchResult answers;
    if (&part == rows)
      checkOnGpu(values.data(), part.size(), group, answers, nullptr, false);
    else
      on_cpu.check(values.data(), part.size(), group, answers);
    result.undecided_states += answers.undecided_states;
    result.undecided_seconds += answers.undecided_seconds;
    for (std::size_t i = 0; i < part.size(); ++i)
    {
      result.valid[part[i]] = answers.valid[i];
      result.colliding[part[i]] = answers.colliding[i];
    }
  }
}

/// States outside the joints' limits have no displacement bounds, so they are never reported as free.
void BatchChecker::Impl::checkAround(const double* states, std::size_t count, const std::string& group,
                                     const Margins& margins, bool ordinary, BatchResult& result)
{
  checkOnGpu(states, count, group, result, &margins, ordinary);
  for (std::size_t i = 0; i < count; ++i)
    if (margins.within[i] == 0)
    {
      result.valid[i] = 0;
      result.colliding[i] = kNoPair;
    }
}

CpuOrGpu::Choice BatchChecker::Impl::choose(const std::string& group, const double* states, std::size_t count)
{
  BatchResult unused;
  const CpuOrGpu::Checks checks{[&](const double* rows, std::size_t size) { on_cpu.check(rows, size, group, unused); },
                                [&](const double* rows, std::size_t size)
                                { checkOnGpu(rows, size, group, unused, nullptr, false); }};
  return cpu_or_gpu.choose(group, on_cpu.scene(), *on_cpu.problem(group), states, count, on_cpu.proofStage(group),
                           checks);
}

BatchChecker::BatchChecker(std::shared_ptr<const PlanningScene> scene, const BatchCheckerOptions& options)
  : impl_(std::make_unique<Impl>(options))
{
  BatchChecker::setScene(std::move(scene));
}

BatchChecker::~BatchChecker() = default;

void BatchChecker::setScene(std::shared_ptr<const PlanningScene> scene)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  const std::shared_ptr<const PlanningScene> previous = impl_->on_cpu.scene();
  impl_->on_cpu.setScene(std::move(scene));
  try
  {
    impl_->gpu_checker.setProblem(impl_->on_cpu.problem(""), impl_->on_cpu.scene()->robot);
  }
  catch (...)
  {
    if (previous)
      impl_->on_cpu.setScene(previous);
    impl_->selected_group.reset();
    throw;
  }
  impl_->selected_group = "";
  if (previous && previous->robot != impl_->on_cpu.scene()->robot)
    impl_->cpu_or_gpu.forget();
}

/// Checks states that were validated, with or without neighbourhoods, and sets `work`.
BatchResult BatchChecker::Impl::timedCheck(const double* states, std::size_t count, const std::string& group,
                                           const JointNeighbourhood* around, bool ordinary)
{
  // Any measurement happens here, before the check is timed.
  const bool is_for_cpu = count == 0 || choose(group, states, count).is_for_cpu;
  if (around && !is_for_cpu)
    gpu_checker.prepareMargins();
  work = {};
  BatchResult result;
  result.revision = on_cpu.scene()->revision;
  const auto start = std::chrono::steady_clock::now();
  std::optional<Margins> margins;
  if (around)
    margins = on_cpu.margins(*around, states, count, group);
  if (is_for_cpu)
    on_cpu.check(states, count, group, result, margins ? &*margins : nullptr);
  else if (margins)
    checkAround(states, count, group, *margins, ordinary, result);
  else
    checkStates(states, count, group, ordinary, result);
  result.seconds = secondsSince(start);
  on_cpu.countStates(work.states, group);
  return result;
}

BatchResult BatchChecker::check(const double* states, std::size_t count, const std::string& group,
                                const JointNeighbourhood* around)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  impl_->on_cpu.problem(group);  // throws for an unknown group
  const bool ordinary = impl_->areOrdinary(states, count, group);
  if (!ordinary)
    validateStates(*impl_->on_cpu.scene()->robot, states, count);
  if (around)
    return impl_->timedCheck(states, count, group, around, ordinary);
  // For each slice, CPU or GPU is chosen anew: the CPU becomes faster while proofs are made.
  BatchResult result = impl_->timedCheck(states, std::min(count, kLargestSlice), group, nullptr, ordinary);
  GpuWork work = impl_->work;
  result.valid.reserve(count);
  result.colliding.reserve(count);
  for (std::size_t begin = kLargestSlice; begin < count; begin += kLargestSlice)
  {
    const double* const first = states + begin * impl_->width();
    result.append(impl_->timedCheck(first, std::min(kLargestSlice, count - begin), group, nullptr, ordinary));
    work += impl_->work;
  }
  impl_->work = work;
  return result;
}

SceneReport BatchChecker::report(const std::string& group)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  SceneReport report = impl_->on_cpu.report(group);
  report.cpu_below = impl_->choose(group, nullptr, 0).threshold;
  return report;
}

GpuWork BatchChecker::lastWork() const
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->work;
}

std::string BatchChecker::deviceWarning() const
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->gpu_checker.fault();
}

std::string BatchChecker::deviceName() const
{
  return impl_->gpu_checker.device().renderer;
}
}  // namespace gpu_planning_scene::core
