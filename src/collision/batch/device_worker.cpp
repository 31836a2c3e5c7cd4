#include "collision/batch/device_worker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <sstream>
#include <thread>
#include <utility>

#include <malloc.h>

#include "base/finally.h"
#include "base/short_slices.h"
#include "collision/batch/device_parts.h"
#include "collision/problem/collision_problem.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;

constexpr double kLongestLimit = 1e8;               // seconds; longer times would overflow the clock's type
constexpr std::chrono::milliseconds kPatience{20};  // a hanging device is noticed this much later
constexpr int kAttempts = 2;                        // for a batch or a scene, if the device is lost

Clock::duration duration(double seconds)
{
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(seconds, kLongestLimit)));
}

/// Trees are built within a call, so large scenes have more time.
double millionTriangles(const CollisionProblem& problem)
{
  std::size_t triangles = 0;
  for (const Tessellation& tessellation : problem.tessellations)
    triangles += tessellation.mesh ? tessellation.mesh->triangles.size() : 0;
  return 1e-6 * static_cast<double>(triangles);
}
}  // namespace

/// The state that the thread and the worker share. The thread uses `device` alone, also to destroy it.
struct DeviceWorker::Shared
{
  using Job = std::function<void(Shared&)>;

  Shared(Open the_open, const DeviceLimits& the_limits)
    : open_device(std::move(the_open)), limits(the_limits), limit_seconds(the_limits.device_seconds)
  {
  }

  void serve();
  void prepare(const DeviceTask& task);
  void checkParts(const DeviceTask& task, DeviceParts& parts);
  void dropDevice();
  bool noteLoss(const std::string& error);
  void noteRefusal(const std::string& error);
  void rest(const std::string& error);
  bool isAbandoned();
  void noteProgress();
  void noteStatus();

  const Open open_device;
  const DeviceLimits limits;
  std::unique_ptr<BatchDevice> device;

  std::mutex mutex;  // guards the members below
  std::condition_variable wake;
  std::condition_variable ended;
  Job job;
  bool is_busy = false;
  bool is_stopping = false;
  bool is_abandoned = false;
  bool is_finished = false;    // the thread no longer needs the device
  std::weak_ptr<Batch> batch;  // of the running job
  std::size_t number = 0;      // in this batch
  Clock::time_point progress;
  double limit_seconds;  // of the running job
  Clock::time_point retry = Clock::time_point::min();
  std::deque<Clock::time_point> losses;
  bool was_open = false;
  DeviceHistory history;
  std::string name;
  bool is_software = false;
  std::string fault;
  std::thread thread;
};

void DeviceWorker::Shared::serve()
{
  runInShortSlices();
  std::unique_lock<std::mutex> lock(mutex);
  while (true)
  {
    wake.wait(lock, [this] { return is_stopping || job; });
    if (!job)
      break;
    Job taken = std::exchange(job, nullptr);
    lock.unlock();
    try
    {
      taken(*this);
    }
    catch (const std::exception&)
    {
      // No memory to note an error. The parts of the device have gone back.
    }
    taken = nullptr;  // destroys the job's objects on this thread
    lock.lock();
    is_busy = false;
    ended.notify_all();
  }
  // The driver may hang here too.
  is_busy = true;
  progress = Clock::now();
  lock.unlock();
  device.reset();
  lock.lock();
  is_busy = false;
  is_finished = true;
  ended.notify_all();
}

bool DeviceWorker::Shared::isAbandoned()
{
  const std::lock_guard<std::mutex> lock(mutex);
  return is_abandoned;
}

void DeviceWorker::Shared::noteProgress()
{
  const std::lock_guard<std::mutex> lock(mutex);
  progress = Clock::now();
}

/// A new fault means that the device has lost an ability.
void DeviceWorker::Shared::noteStatus()
{
  std::string new_name = device->name();
  std::string new_fault = device->fault();
  const std::lock_guard<std::mutex> lock(mutex);
  if (is_abandoned)
    return;
  name = std::move(new_name);
  history.on_cpu = false;
  if (fault == new_fault)
    return;
  fault = std::move(new_fault);
  if (!fault.empty() && was_open)
  {
    ++history.losses;
    history.last_error = fault;
  }
}

/// Opens the device if it is not open. Throws the errors of the device.
void DeviceWorker::Shared::prepare(const DeviceTask& task)
{
  const bool is_new = !device;
  if (is_new)
  {
    device = open_device();
    noteProgress();
  }
  device->prepare(task);
  if (is_new)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (is_abandoned)
      return;
    history.rebuilds += was_open ? 1 : 0;
    history.rebuild_failed = false;
    name = device->name();
    is_software = device->isSoftware();
    fault = device->fault();
    was_open = true;
  }
  noteProgress();
  noteStatus();
}

void DeviceWorker::Shared::checkParts(const DeviceTask& task, DeviceParts& parts)
{
  try
  {
    prepare(task);
    device->check(parts);
    noteStatus();
  }
  catch (...)
  {
    parts.giveBack();
    throw;
  }
}

void DeviceWorker::Shared::dropDevice()
{
  if (!device)
    return;
  noteProgress();
  device.reset();
  noteProgress();
  // A software renderer has hundreds of megabytes on the heap, which free() alone would not return to the system.
  malloc_trim(0);
}

/// The device is not used for some time.
void DeviceWorker::Shared::rest(const std::string& error)
{
  const std::lock_guard<std::mutex> lock(mutex);
  if (is_abandoned)
    return;
  retry = Clock::now() + duration(limits.retry_seconds);
  history.on_cpu = true;
  history.last_error = error;
}

/// Returns whether the device may be opened again now.
bool DeviceWorker::Shared::noteLoss(const std::string& error)
{
  const bool was_opening = !device;
  dropDevice();
  const Clock::time_point now = Clock::now();
  bool too_often = false;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (is_abandoned)  // while it was dropped
      return false;
    history.rebuild_failed = history.rebuild_failed || (was_opening && was_open);
    ++history.losses;
    history.last_error = error;
    losses.push_back(now);
    while (losses.front() < now - duration(limits.loss_window))
      losses.pop_front();
    too_often = losses.size() >= limits.max_losses;
  }
  if (too_often)
    rest(error);
  return !too_often;
}

/// The device cannot be opened, or cannot hold the scene.
void DeviceWorker::Shared::noteRefusal(const std::string& error)
{
  const bool was_opening = !device;
  dropDevice();
  rest(error);
  const std::lock_guard<std::mutex> lock(mutex);
  history.rebuild_failed = history.rebuild_failed || (was_opening && was_open);
}

DeviceWorker::DeviceWorker(Open open, const DeviceLimits& limits)
  : shared_(std::make_shared<Shared>(std::move(open), limits))
{
  shared_->thread = std::thread([shared = shared_] { shared->serve(); });
}

void DeviceWorker::stop()
{
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  shared_->is_stopping = true;
  shared_->wake.notify_one();
}

DeviceWorker::~DeviceWorker()
{
  stop();
  std::unique_lock<std::mutex> lock(shared_->mutex);
  while (!shared_->is_finished && !shared_->is_abandoned)
  {
    shared_->ended.wait_for(lock, kPatience);
    lock.unlock();
    try
    {
      abandonIfOverdue();
    }
    catch (const std::exception&)
    {
      // No memory for its message. The next time, there may be some.
    }
    lock.lock();
  }
  if (shared_->is_abandoned)
    return;
  lock.unlock();
  shared_->thread.join();
}

bool DeviceWorker::waitFor(std::chrono::milliseconds time)
{
  {
    std::unique_lock<std::mutex> lock(shared_->mutex);
    if (shared_->ended.wait_for(lock, time, [this] { return !shared_->is_busy || shared_->is_abandoned; }))
      return true;
  }
  return abandonIfOverdue();
}

bool DeviceWorker::begin(Shared::Job job, const DeviceTask& task, const std::shared_ptr<Batch>& batch,
                         std::size_t number, bool must_rest)
{
  const double limit = shared_->limits.device_seconds * (1.0 + millionTriangles(*task.scene));
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  if (shared_->is_busy || shared_->is_abandoned || (must_rest && Clock::now() < shared_->retry))
    return false;
  if (batch)
    batch->join(number);
  shared_->job = std::move(job);
  shared_->is_busy = true;
  shared_->batch = batch;
  shared_->number = number;
  shared_->progress = Clock::now();
  shared_->limit_seconds = limit;
  shared_->wake.notify_one();
  return true;
}

void DeviceWorker::open(const DeviceTask& task)
{
  const auto error = std::make_shared<std::exception_ptr>();
  begin(
      [error, task](Shared& shared)
      {
        try
        {
          shared.prepare(task);
        }
        catch (const std::exception& refusal)
        {
          *error = std::current_exception();
          shared.noteRefusal(refusal.what());
        }
      },
      task, nullptr, 0, false);
  std::unique_lock<std::mutex> lock(shared_->mutex);
  shared_->ended.wait(lock, [this] { return !shared_->is_busy; });
  lock.unlock();
  if (*error)
    std::rethrow_exception(std::exchange(*error, nullptr));
}

namespace
{
/// Runs `work`; if the device is lost, once more. Notes all errors, and throws none.
template <class SharedState, class Work>
void runTolerantly(SharedState& shared, const Work& work)
{
  for (int attempt = 1; attempt <= kAttempts; ++attempt)
    try
    {
      return work();
    }
    catch (const DeviceLost& error)
    {
      if (shared.isAbandoned() || !shared.noteLoss(error.what()))
        return;
      if (attempt == kAttempts)
        shared.rest(error.what());
    }
    catch (const std::exception& error)
    {
      return shared.isAbandoned() ? void() : shared.noteRefusal(error.what());
    }
}
}  // namespace

void DeviceWorker::prepare(const DeviceTask& task)
{
  begin(
      [task](Shared& shared)
      {
        runTolerantly(
            shared, [&] { shared.prepare(task); });
      },
      task, nullptr, 0, true);
}

bool DeviceWorker::isFree() const
{
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return !shared_->is_busy && !shared_->is_abandoned && Clock::now() >= shared_->retry;
}

bool DeviceWorker::start(const std::shared_ptr<Batch>& batch, const DeviceTask& task, std::size_t device, double share)
{
  return begin(
      [batch, task, device, share](Shared& shared)
      {
        DeviceParts parts(
            batch, device, share, [&shared] { shared.noteProgress(); });
        const Finally leave([&] { parts.leave(); });
        runTolerantly(
            shared, [&] { shared.checkParts(task, parts); });
      },
      task, batch, device, true);
}

/// The thread then owns what the device uses.
bool DeviceWorker::abandonIfOverdue()
{
  std::shared_ptr<Batch> batch;
  {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    if (!shared_->is_busy || shared_->is_abandoned || !std::isfinite(shared_->limits.device_seconds) ||
        Clock::now() - shared_->progress <= duration(shared_->limit_seconds))
      return false;
    std::ostringstream message;
    message << "the device has not answered for " << shared_->limit_seconds << " s and is no longer used";
    shared_->history.last_error = message.str();  // before the changes that must not be left half done
    shared_->is_abandoned = true;
    shared_->is_stopping = true;  // the thread exits if the device returns after all
    ++shared_->history.losses;
    shared_->history.on_cpu = true;
    shared_->history.rebuild_failed = true;
    batch = shared_->batch.lock();
    shared_->thread.detach();
    shared_->wake.notify_one();
    shared_->ended.notify_all();
  }
  if (batch)
    batch->leave(shared_->number);
  return true;
}

std::string DeviceWorker::name() const
{
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return shared_->name;
}

bool DeviceWorker::isClosed() const
{
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return shared_->history.on_cpu || !shared_->was_open;
}

bool DeviceWorker::isSoftware() const
{
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return shared_->is_software;
}

std::string DeviceWorker::fault() const
{
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return shared_->fault;
}

DeviceHistory DeviceWorker::history() const
{
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return shared_->history;
}
}  // namespace gpu_planning_scene::core
