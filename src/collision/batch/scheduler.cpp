#include "collision/batch/scheduler.h"

#include <algorithm>
#include <chrono>
#include <list>
#include <mutex>
#include <shared_mutex>
#include <utility>

#include "base/available_cores.h"
#include "base/finally.h"
#include "base/helper_thread.h"
#include "base/seconds_since.h"
#include "collision/batch/device_rows.h"
#include "collision/problem/batch_size.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;

// For so few states, threads do not pay. A state with margins takes some ten times as long.
constexpr std::size_t kFewStates = 256;
constexpr std::size_t kFewStatesWithMargins = 64;
// A core is started for each such number of states, if there are more than a few.
constexpr std::size_t kStatesPerCore = 32;
// The caller hears of the progress this often, and devices may join this often.
constexpr std::chrono::milliseconds kTick{20};
// The parts of a core.
constexpr BatchSize::Limits kCoreParts = {0.005, 32, 8, 1024};
}  // namespace

/// Calls StateBatch::go_on from time to time.
class Scheduler::Progress
{
 public:
  Progress(const StateBatch& asked, const Batch& batch) : asked_(asked), batch_(batch) {}

  /// Whether a tick has passed since the last one. Throws Cancelled.
  bool tick()
  {
    if (Clock::now() < next_)
      return false;
    next_ = Clock::now() + kTick;
    if (asked_.go_on && !asked_.go_on(batch_.answeredCount()))
      throw Cancelled();
    return true;
  }

 private:
  const StateBatch& asked_;
  const Batch& batch_;
  Clock::time_point next_ = Clock::now() + kTick;
};

/// Lets devices join a batch, at its start and later.
class Scheduler::DeviceJoin
{
 public:
  DeviceJoin(Scheduler& scheduler, const StateBatch& asked, std::shared_ptr<Batch> batch)
    : scheduler_(scheduler), asked_(asked), batch_(std::move(batch))
  {
  }

  void invite()
  {
    DevicePool& devices = scheduler_.devices_;
    devices.abandonOverdue();
    if (is_useless_ || !devices.suits(asked_.group, batch_->waitingCount()))
      return;
    if (!task_.robot)
    {
      DeviceTask task = scheduler_.taskOf(asked_.group);
      auto rows = rowsForDevices(asked_, batch_->margins(), *task.robot, task.group);
      is_useless_ = !rows->suitSomewhere();
      batch_->setDeviceRows(std::move(rows));
      task_ = std::move(task);
    }
    if (!is_useless_ && devices.join(batch_, task_, asked_.group))
      has_joined_ = true;
  }

  bool hasJoined() const { return has_joined_; }

 private:
  Scheduler& scheduler_;
  const StateBatch& asked_;
  const std::shared_ptr<Batch> batch_;
  DeviceTask task_;
  bool is_useless_ = false;  // devices can check few of the states, if any
  bool has_joined_ = false;
};

Scheduler::Scheduler(const CheckerOptions& options, std::vector<std::unique_ptr<DeviceWorker>> devices,
                     bool device_only)
  : scene_(options), devices_(std::move(devices), device_only)
{
}

void Scheduler::setOnCpu(std::shared_ptr<const PlanningScene> scene)
{
  const bool is_other_robot = scene_.scene() && scene && scene->robot != scene_.scene()->robot;
  scene_.setScene(std::move(scene), !devices_.isDeviceOnly() || devices_.isEmpty());
  if (is_other_robot)
    devices_.forgetPaces();
}

void Scheduler::setScene(std::shared_ptr<const PlanningScene> scene)
{
  const std::lock_guard<ChangeGate> lock(gate_);
  setOnCpu(std::move(scene));
  if (devices_.isEmpty())
    return;
  try
  {
    devices_.prepare(taskOf(""));
  }
  catch (const std::exception&)
  {
    // The next batch brings them the scene.
  }
}

void Scheduler::openDevices(std::shared_ptr<const PlanningScene> scene, bool one_suffices)
{
  const std::lock_guard<ChangeGate> lock(gate_);
  setOnCpu(std::move(scene));
  devices_.open(taskOf(""), one_suffices);
}

DeviceTask Scheduler::taskOf(const std::string& group)
{
  return {scene_.scene()->robot, scene_.problem(""), scene_.problem(group), scene_.deviceProofs(group)};
}

BatchResult Scheduler::check(const StateBatch& asked)
{
  const std::shared_lock<ChangeGate> lock(gate_);
  const auto start = Clock::now();
  const bool by_device = devices_.isDeviceOnly() && !devices_.isEmpty() && asked.count != 0;
  const std::size_t few = asked.around ? kFewStatesWithMargins : kFewStates;
  const bool on_caller =
      (asked.count <= few && !by_device) || scene_.problem(asked.group)->always_colliding.has_value();
  BatchResult result = on_caller ? checkOnCaller(asked) : checkTogether(asked);
  result.revision = scene_.scene()->revision;
  result.seconds = secondsSince(start);
  return result;
}

/// Validates the states, and returns their margins if the batch has a neighbourhood.
std::optional<Margins> Scheduler::marginsOf(const StateBatch& asked)
{
  validateStates(*scene_.scene()->robot, asked.states, asked.count);
  if (!asked.around)
    return {};
  return scene_.margins(*asked.around, asked.states, asked.count, asked.group);
}

/// The Core locks the scene when it is made and in endBatch. Otherwise, the check of a single state usually locks
/// nothing of the scene: each lock would take a percent of its time.
BatchResult Scheduler::checkOnCaller(const StateBatch& asked)
{
  CpuScene::Core core(scene_, asked.group);  // throws for an unknown group
  const std::optional<Margins> margins = marginsOf(asked);
  BatchResult result;
  result.valid.assign(asked.count, 1);
  result.colliding.assign(asked.count, kNoPair);
  core.check(asked.states, {{0, asked.count}}, margins ? &*margins : nullptr, result);
  core.endBatch(asked.count);
  if (!devices_.isEmpty())
    noteWork({});
  return result;
}

BatchResult Scheduler::checkTogether(const StateBatch& asked)
{
  const auto batch = std::make_shared<Batch>(asked.count, marginsOf(asked), availableCores());
  const Finally close([&] { batch->close(); });
  DeviceJoin devices(*this, asked, batch);
  Progress progress(asked, *batch);
  bool has_turn = false;
  const Finally give_turn(
      [&]
      {
        if (has_turn)
          turn_.give();
      });
  if (!devices_.isEmpty())
    devices_.noteProofs(asked.group, scene_.proofStage(asked.group));
  if (!devices_.isEmpty() && devices_.isDeviceOnly())
  {
    while (!(has_turn = turn_.takeFor(kTick)))
      progress.tick();
    while (!devices_.waitFor(kTick))
      progress.tick();
    batch->letCoresHelp(false);  // before a device joins: it may already leave in `invite`
    devices.invite();
    if (!devices.hasJoined())
      batch->letCoresHelp(true);
  }
  const auto start = Clock::now();
  runCores(*batch, asked, devices, progress);
  const double seconds = secondsSince(start);
  batch->close();
  BatchResult result = batch->takeResult();
  scene_.countBatch(asked.count, result.device_states, asked.group);
  if (devices_.isEmpty())
    return result;
  devices_.learn(*batch, asked.group, asked.count - result.device_states, devices_.isDeviceOnly() ? 0.0 : seconds);
  noteWork(batch->work());
  if (!devices.hasJoined() && devices_.isUnusable())
    ++batches_on_cpu_;
  return result;
}

/// Checks parts on all cores until the batch has ended. The calling thread is one of the cores.
void Scheduler::runCores(Batch& batch, const StateBatch& asked, DeviceJoin& devices, Progress& progress)
{
  const auto or_fail = [&batch](const auto& act)
  {
    try
    {
      act();
    }
    catch (...)
    {
      batch.fail(std::current_exception());
    }
  };
  const auto tick = [&]
  {
    if (progress.tick() && !devices_.isEmpty())
      devices.invite();
  };
  const auto work = [&](bool is_caller)
  {
    std::optional<CpuScene::Core> core;
    BatchSize size(kCoreParts);
    std::vector<StateRange> part;
    for (batch.takeForCore(size.size(), part); !part.empty(); batch.takeForCore(size.size(), part))
    {
      if (!core)
        core.emplace(scene_, asked.group);
      const auto start = Clock::now();
      const std::size_t states = core->check(asked.states, part, batch.margins(), batch.result());
      batch.answered(part);
      size.took(states, secondsSince(start));
      if (is_caller)
        tick();
    }
  };
  for (bool is_first = true; !batch.isClosed() && !batch.isComplete(); is_first = false)
  {
    std::list<HelperThread> helpers;
    try
    {
      const std::size_t wanted = std::min(availableCores(), batch.availableForCores() / kStatesPerCore);
      while (helpers.size() + 1 < wanted)
        helpers.emplace_back([&] { or_fail([&] { work(false); }); });
    }
    catch (const std::exception&)
    {
      // No thread, or no memory for one. The threads that could be started do all the work.
    }
    or_fail(
        [&]
        {
          if (is_first && !devices_.isEmpty() && !devices.hasJoined())
            devices.invite();
          work(true);
        });
    helpers.clear();
    batch.waitForCores(Clock::now() + kTick);
    if (!batch.isClosed())
      or_fail(tick);
  }
}

void Scheduler::noteWork(const GpuWork& work)
{
  const std::lock_guard<std::mutex> lock(work_mutex_);
  last_work_ = work;
}

SceneReport Scheduler::report(const std::string& group)
{
  const std::shared_lock<ChangeGate> lock(gate_);
  return scene_.report(group);
}

DeviceHistory Scheduler::history() const
{
  DeviceHistory history = devices_.history();
  history.batches_on_cpu = batches_on_cpu_;
  return history;
}

GpuWork Scheduler::lastWork() const
{
  const std::lock_guard<std::mutex> lock(work_mutex_);
  return last_work_;
}
}  // namespace gpu_planning_scene::core
