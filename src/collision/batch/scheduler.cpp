#include "collision/batch/scheduler.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <shared_mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "collision/available_cores.h"
#include "collision/gpu/placeable_states.h"
#include "collision/problem/state_validation.h"
#include "collision/rows_without.h"
#include "gpu_planning_scene/error.h"
#include "model/seconds_since.h"

namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;

// Checking this many states takes less time than starting a thread.
constexpr std::size_t kFewStates = 256;
// The caller hears of the progress this often, and hanging devices are noticed.
constexpr std::chrono::milliseconds kPatience{20};

// Before the rates are known, devices join batches of this many states.
constexpr std::size_t kLeastForDevice = 4096;
// The rate of a software renderer is measured with this many states, once for each set of proofs, within a batch of at
// least the second number of states.
constexpr std::size_t kProbe = 4096;
constexpr std::size_t kLeastForProbe = 16'384;
// A software renderer must be faster than the cores by this factor.
constexpr double kClearly = 1.2;
// A device joins a batch if the cores alone would take this many times the device's latency.
constexpr double kLatencies = 2.0;
// A part is this fraction of the share of the waiting states that the device would get by its rate.
constexpr double kAhead = 0.5;
constexpr std::size_t kAnyNumber = static_cast<std::size_t>(-1);

/// Calls StateBatch::go_on from time to time.
class Progress
{
 public:
  explicit Progress(const StateBatch& asked) : asked_(asked) {}

  /// Throws Cancelled.
  void tell(const Batch& batch)
  {
    if (!asked_.go_on || Clock::now() < next_)
      return;
    next_ = Clock::now() + kPatience;
    if (!asked_.go_on(batch.answeredCount()))
      throw Cancelled();
  }

 private:
  const StateBatch& asked_;
  Clock::time_point next_ = Clock::now() + kPatience;
};
}  // namespace

Scheduler::Scheduler(const CheckerOptions& options, std::vector<std::unique_ptr<DeviceWorker>> devices,
                     bool device_only)
  : scene_(options), device_only_(device_only), devices_(std::move(devices))
{
}

void Scheduler::setOnCpu(std::shared_ptr<const PlanningScene> scene)
{
  scene_.setScene(std::move(scene));
  if (!device_only_ || devices_.empty())
    scene_.prepare("");
}

void Scheduler::setScene(std::shared_ptr<const PlanningScene> scene)
{
  const std::lock_guard<ChangeGate> lock(gate_);
  setOnCpu(std::move(scene));
  for (const auto& device : devices_)
    device->prepare(taskOf(""));
}

void Scheduler::openDevices(std::shared_ptr<const PlanningScene> scene)
{
  const std::lock_guard<ChangeGate> lock(gate_);
  setOnCpu(std::move(scene));
  for (const auto& device : devices_)
    device->open(taskOf(""));
}

DeviceTask Scheduler::taskOf(const std::string& group)
{
  return {scene_.scene()->robot, scene_.problem(""), scene_.problem(group), scene_.deviceProofs(group)};
}

Scheduler::Plan Scheduler::plan(std::size_t count) const
{
  Plan plan;
  const double cores = cores_rate_;
  double together = cores;
  for (const auto& device : devices_)
    together += device->isSoftware() ? 0.0 : device->rate();
  for (std::size_t i = 0; i < devices_.size(); ++i)
  {
    DeviceWorker& worker = *devices_[i];
    worker.abandonIfOverdue();
    if (device_only_)
      worker.wait();
    if (!worker.isFree())
      continue;
    const double rate = worker.rate();
    if (device_only_)
    {
      plan.devices.push_back({i, kAhead / static_cast<double>(devices_.size()), kAnyNumber, 0});
      plan.cores_help = false;
    }
    else if (!worker.isSoftware())
    {
      const bool pays = rate == 0.0 || cores == 0.0
                            ? count >= kLeastForDevice
                            : static_cast<double>(count) > kLatencies * cores * worker.latency();
      if (pays)
        plan.devices.push_back({i, rate == 0.0 ? kAhead / 2.0 : kAhead * rate / together, kAnyNumber, 0});
    }
    else if (cores != 0.0 && rate == 0.0 && count >= kLeastForProbe)
      plan.devices.push_back({i, 1.0, kProbe, 1});
    else if (cores != 0.0 && rate > kClearly * cores && count >= kLeastForDevice)
    {
      plan.devices.push_back({i, kAhead, kAnyNumber, 0});
      plan.cores_help = false;
    }
  }
  return plan;
}

/// The states for which the problem is not valid, or which devices cannot place, ascending. With margins, states
/// outside the joints' limits have no displacement bounds, so the cores report them as not free.
std::vector<std::size_t> Scheduler::onlyForCores(const StateBatch& asked, const Margins* margins)
{
  const RobotModel& robot = *scene_.scene()->robot;
  const std::size_t width = robot.variables().size();
  const PlaceableStates placeable(robot);
  const auto problem = scene_.problem(asked.group);
  return rowsWithout(asked.count,
                     [&](std::size_t row)
                     {
                       const double* const state = asked.states + row * width;
                       return (margins ? margins->within[row] != 0 : isValidFor(*problem, state)) &&
                              placeable.contains(state);
                     });
}

BatchResult Scheduler::check(const StateBatch& asked)
{
  const std::shared_lock<ChangeGate> lock(gate_);
  const auto& problem = scene_.problem(asked.group);  // throws for an unknown group
  validateStates(*scene_.scene()->robot, asked.states, asked.count);
  const auto start = Clock::now();
  std::optional<Margins> margins;
  if (asked.around)
    margins = scene_.margins(*asked.around, asked.states, asked.count, asked.group);
  Plan devices;
  std::unique_lock<std::mutex> turn(turn_, std::defer_lock);
  if (!devices_.empty() && asked.count != 0 && !problem->always_colliding)
  {
    if (device_only_)
      turn.lock();
    if (asked.count >= kLeastForDevice)
      noteProofs(scene_.proofStage(asked.group));
    devices = plan(asked.count);
  }
  const bool is_small = devices.devices.empty() && asked.count <= kFewStates;
  BatchResult result = is_small ? checkOnCaller(asked, margins ? &*margins : nullptr)
                                : checkTogether(asked, std::move(margins), devices);
  result.revision = scene_.scene()->revision;
  result.seconds = secondsSince(start);
  if (!devices_.empty() && devices.devices.empty() && history().on_cpu)
    ++batches_on_cpu_;
  return result;
}

BatchResult Scheduler::checkOnCaller(const StateBatch& asked, const Margins* margins)
{
  BatchResult result;
  result.valid.assign(asked.count, 1);
  result.colliding.assign(asked.count, kNoPair);
  CpuScene::Core(scene_, asked.group).check(asked.states, {0, asked.count}, margins, result);
  scene_.countBatch(asked.count, 0, asked.group);
  noteWork({});
  return result;
}

void Scheduler::noteWork(const GpuWork& work)
{
  if (devices_.empty())
    return;
  const std::lock_guard<std::mutex> lock(work_mutex_);
  last_work_ = work;
}

BatchResult Scheduler::checkTogether(const StateBatch& borrowed, std::optional<Margins> margins, const Plan& plan)
{
  // A device that hangs may read the states after the call.
  StateBatch asked = borrowed;
  if (!plan.devices.empty() && !asked.owner)
  {
    const std::size_t width = scene_.scene()->robot->variables().size();
    const auto copy = std::make_shared<const std::vector<double>>(asked.states, asked.states + asked.count * width);
    asked.states = copy->data();
    asked.owner = copy;
  }
  std::vector<std::size_t> for_cores;
  if (!plan.devices.empty())
    for_cores = onlyForCores(asked, margins ? &*margins : nullptr);
  const auto batch = std::make_shared<Batch>(asked, std::move(margins), availableCores(), for_cores);
  std::size_t joined = 0;
  if (!plan.devices.empty())
  {
    batch->letCoresHelp(plan.cores_help);
    const DeviceTask task = taskOf(asked.group);
    for (const Invitation& invited : plan.devices)
      joined +=
          devices_[invited.device]->start(batch, task, invited.device, invited.share, invited.most, invited.rounds) ? 1
                                                                                                                    : 0;
    if (joined == 0)
      batch->letCoresHelp(true);
  }
  const auto start = Clock::now();
  runCores(*batch, asked);
  // Without an owner, devices may still read the states.
  if (!asked.owner)
    batch->waitForDevices();
  batch->close();
  if (const std::exception_ptr error = batch->error())
    std::rethrow_exception(error);
  if (!batch->isComplete())  // the others would stay free
    throw std::logic_error("a batch has ended with states that have no answer");
  BatchResult result = std::move(batch->result());
  result.device_states = batch->answeredByDevices();
  if (plan.cores_help)
    noteCores(asked.count - result.device_states, secondsSince(start));
  noteWork(batch->work());
  scene_.countBatch(asked.count, result.device_states, asked.group);
  return result;
}

/// Checks parts on all cores until the batch has ended. The calling thread is one of the cores.
void Scheduler::runCores(Batch& batch, const StateBatch& asked)
{
  const auto work = [&](Progress* progress)
  {
    try
    {
      std::optional<CpuScene::Core> core;
      for (StateRange part = batch.takeForCore(kAnyNumber); part.count != 0; part = batch.takeForCore(kAnyNumber))
      {
        if (!core)
          core.emplace(scene_, asked.group);
        core->check(asked.states, part, batch.margins(), batch.result());
        batch.answered(part);
        if (progress)
          progress->tell(batch);
      }
    }
    catch (...)
    {
      batch.fail(std::current_exception());
    }
  };
  Progress progress(asked);
  while (true)
  {
    std::vector<std::thread> helpers;
    try
    {
      const std::size_t wanted = std::min(availableCores(), batch.availableForCores() / kFewStates);
      while (helpers.size() + 1 < wanted)
        helpers.emplace_back(work, nullptr);
    }
    catch (const std::exception&)
    {
      // No thread, or no memory for one. The threads that could be started do all the work.
    }
    work(&progress);
    for (std::thread& helper : helpers)
      helper.join();
    if (batch.isClosed() || batch.isComplete())
      return;
    batch.waitForCores(Clock::now() + kPatience);
    try
    {
      progress.tell(batch);
    }
    catch (...)
    {
      batch.fail(std::current_exception());
    }
    if (asked.owner)
      for (const auto& device : devices_)
        device->abandonIfOverdue();
  }
}

void Scheduler::noteCores(std::size_t states, double seconds)
{
  constexpr double kNewest = 0.5;  // weight of the newest batch
  if (states < kFewStates || seconds <= 0.0)
    return;
  const double rate = static_cast<double>(states) / seconds;
  const double known = cores_rate_;
  cores_rate_ = known == 0.0 ? rate : known + kNewest * (rate - known);
}

/// With better proofs, the rates of the devices and of the cores are others.
void Scheduler::noteProofs(ProofStage stage)
{
  {
    const std::lock_guard<std::mutex> lock(work_mutex_);
    if (stage <= known_proofs_)
      return;
    known_proofs_ = stage;
  }
  for (const auto& device : devices_)
    device->forgetRate();
  cores_rate_ = 0.0;
}

SceneReport Scheduler::report(const std::string& group)
{
  const std::shared_lock<ChangeGate> lock(gate_);
  return scene_.report(group);
}

std::string Scheduler::deviceName() const
{
  std::string names;
  for (const auto& device : devices_)
    if (!device->history().on_cpu)
      names += (names.empty() ? "" : " + ") + device->name();
  return names.empty() ? "CPU" : names;
}

std::string Scheduler::deviceWarning() const
{
  std::string warnings;
  const auto add = [&warnings](const std::string& warning)
  { warnings += (warnings.empty() || warning.empty() ? "" : "; ") + warning; };
  for (const auto& device : devices_)
    if (const DeviceHistory history = device->history(); !history.on_cpu)
      add(device->fault());
    else if (devices_.size() == 1)
      add("the device has failed, so the CPU checks the states: " + history.last_error);
    else
      add("the device " + device->name() + " has failed and is not used: " + history.last_error);
  return warnings;
}

DeviceHistory Scheduler::history() const
{
  DeviceHistory sum;
  sum.on_cpu = !devices_.empty();
  for (const auto& device : devices_)
  {
    const DeviceHistory history = device->history();
    sum.losses += history.losses;
    sum.rebuilds += history.rebuilds;
    sum.on_cpu = sum.on_cpu && history.on_cpu;
    sum.rebuild_failed = sum.rebuild_failed || history.rebuild_failed;
    if (!history.last_error.empty())
      sum.last_error = history.last_error;
  }
  sum.batches_on_cpu = batches_on_cpu_;
  return sum;
}

GpuWork Scheduler::lastWork() const
{
  const std::lock_guard<std::mutex> lock(work_mutex_);
  return last_work_;
}
}  // namespace gpu_planning_scene::core
