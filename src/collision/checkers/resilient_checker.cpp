#include "collision/checkers/resilient_checker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>
#include <mutex>
#include <sstream>
#include <utility>
#include <vector>

#include <malloc.h>

#include "collision/checkers/abandonable_thread.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"

// A request whose device is lost is repeated with a new checker on the device. After too many losses in a short time,
// the CPU answers, and the device is tried again later. Own method.
namespace gpu_planning_scene::core
{
namespace
{
using Clock = std::chrono::steady_clock;
using Scene = std::shared_ptr<const PlanningScene>;

// Longer waits would overflow the clock's type.
constexpr double kNoLimit = 1e8;  // seconds

Clock::duration duration(double seconds)
{
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

double millionTriangles(const PlanningScene& scene)
{
  std::size_t triangles = scene.robot->triangleCount();
  const auto count = [&triangles](const WorldObject& object)
  {
    for (const PlacedShape& placed : object.shapes)
      if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape))
        triangles += *mesh ? (*mesh)->triangles.size() : 0;
  };
  std::for_each(scene.objects.begin(), scene.objects.end(), count);
  for (const AttachedObject& attached : scene.attached)
    count(attached.object);
  return 1e-6 * static_cast<double>(triangles);
}
}  // namespace

struct ResilientChecker::Impl
{
  /// The device's checker. Only the device's thread uses it. The jobs share it, so that it is destroyed on this thread
  /// too.
  struct Slot
  {
    std::unique_ptr<StateChecker> checker;
  };
  template <class Result>
  using Request = std::function<Result(StateChecker&)>;  // must own all objects that it uses, see AbandonableThread

  Impl(Make make_the_device, Make make_the_cpu, const ResilientOptions& the_options)
    : make_device(std::move(make_the_device)), make_cpu(std::move(make_the_cpu)), options(the_options)
  {
  }

  template <class Result>
  Result request(const Scene& scene, const Request<Result>& work);
  bool hasLimit() const { return std::isfinite(options.device_seconds); }
  bool placeOnDevice(const Scene& scene);
  void placeOnCpu(const Scene& scene);
  void openDevice(const Scene& scene, double seconds);
  void run(const std::function<void()>& job, double seconds);
  void noteStatus(const std::string& name, const std::string& warning);
  void noteFailedRebuild();
  void dropDevice();
  void noteLoss(const std::string& error);
  void useCpu(const std::string& error);

  const Make make_device;
  const Make make_cpu;
  const ResilientOptions options;

  std::mutex mutex;  // guards all members below except the status
  Scene scene;
  std::shared_ptr<Slot> device;  // null: no device is open
  Scene device_scene;
  std::unique_ptr<StateChecker> cpu;
  Scene cpu_scene;
  bool answered_by_cpu = false;  // the CPU answered the last request
  bool opened_before = false;
  bool lost = false;  // the device was lost and has not been reopened
  double seconds_per_call = 0.0;
  std::deque<Clock::time_point> losses;
  Clock::time_point retry = Clock::time_point::min();  // the CPU answers until this time
  AbandonableThread thread;

  mutable std::mutex status_mutex;  // guards the members below, for callers that do not wait for a running check
  DeviceHistory history;
  std::string device_name;
  std::string device_warning;
};

/// Throws DeviceLost if the job does not end in time. The abandoned thread then owns the objects that the job uses.
void ResilientChecker::Impl::run(const std::function<void()>& job, double seconds)
{
  if (!hasLimit())
    return job();
  if (thread.run(job, std::min(seconds, kNoLimit)))
    return;
  device.reset();
  noteFailedRebuild();  // no thread is left that could open the device again
  std::ostringstream message;
  message << "the device has not answered for " << seconds << " s and is no longer used";
  throw DeviceLost(message.str());
}

void ResilientChecker::Impl::openDevice(const Scene& the_scene, double seconds)
{
  struct Opened
  {
    Slot slot;
    std::string name;
    std::string warning;
  };
  const auto opened = std::make_shared<Opened>();
  run(
      [opened, make = make_device, the_scene]
      {
        opened->slot.checker = make(the_scene);
        opened->name = opened->slot.checker->deviceName();
        opened->warning = opened->slot.checker->deviceWarning();
      },
      seconds);
  device = std::shared_ptr<Slot>(opened, &opened->slot);
  device_scene = the_scene;
  const std::lock_guard<std::mutex> lock(status_mutex);
  lost = false;
  history.rebuilds += std::exchange(opened_before, true) ? 1 : 0;
  history.rebuild_failed = false;
  device_name = opened->name;
  device_warning = opened->warning;
}

/// A new warning means that the checker has lost one of several devices, or an ability of its device.
void ResilientChecker::Impl::noteStatus(const std::string& name, const std::string& warning)
{
  const std::lock_guard<std::mutex> lock(status_mutex);
  device_name = name;
  if (warning == device_warning)
    return;
  device_warning = warning;
  if (warning.empty())
    return;
  ++history.losses;
  history.last_error = warning;
}

void ResilientChecker::Impl::noteFailedRebuild()
{
  const std::lock_guard<std::mutex> lock(status_mutex);
  history.rebuild_failed = true;
}

void ResilientChecker::Impl::dropDevice()
{
  if (!device)
    return;
  try
  {
    run(
        [slot = std::exchange(device, nullptr)]
        {
          slot->checker.reset();
          // A software renderer has hundreds of megabytes on the heap, which free() alone would not return to the
          // system.
          malloc_trim(0);
        },
        seconds_per_call);
  }
  catch (const DeviceLost& error)
  {
    useCpu(error.what());
  }
}

void ResilientChecker::Impl::useCpu(const std::string& error)
{
  retry = Clock::now() + duration(options.retry_seconds);
  const std::lock_guard<std::mutex> lock(status_mutex);
  history.last_error = error;
}

void ResilientChecker::Impl::noteLoss(const std::string& error)
{
  if (!device)
    noteFailedRebuild();
  dropDevice();
  lost = true;
  {
    const std::lock_guard<std::mutex> lock(status_mutex);
    ++history.losses;
    history.last_error = error;
  }
  const Clock::time_point now = Clock::now();
  losses.push_back(now);
  while (losses.front() < now - duration(options.loss_window))
    losses.pop_front();
  if (losses.size() >= options.max_losses)
    useCpu(error);
}

/// Gives the scene to the device. Returns whether the device has it now. Throws DeviceLost. Throws Error if neither the
/// device nor the CPU accepts the scene.
bool ResilientChecker::Impl::placeOnDevice(const Scene& the_scene)
{
  if (device && device_scene == the_scene)
    return true;
  seconds_per_call = options.device_seconds * (1.0 + millionTriangles(*the_scene));
  try
  {
    if (device)
    {
      run([slot = device, the_scene] { slot->checker->setScene(the_scene); }, seconds_per_call);
      device_scene = the_scene;
    }
    else
    {
      openDevice(the_scene, seconds_per_call);
    }
    return true;
  }
  catch (const DeviceLost&)
  {
    throw;
  }
  catch (const std::exception& error)
  {
    if (lost)
      noteFailedRebuild();
    dropDevice();
    placeOnCpu(the_scene);  // throws if the scene is invalid; the next request then opens the device again
    useCpu(error.what());
    return false;
  }
}

void ResilientChecker::Impl::placeOnCpu(const Scene& the_scene)
{
  if (!cpu)
    cpu = make_cpu(the_scene);
  else if (cpu_scene != the_scene)
    cpu->setScene(the_scene);
  cpu_scene = the_scene;
}

template <class Result>
Result ResilientChecker::Impl::request(const Scene& the_scene, const Request<Result>& work)
{
  const auto answered_by = [this](bool by_cpu)
  {
    answered_by_cpu = by_cpu;
    const std::lock_guard<std::mutex> lock(status_mutex);
    history.on_cpu = by_cpu;
  };
  constexpr int kAttempts = 2;
  for (int attempt = 1; attempt <= kAttempts && !thread.givenUp() && Clock::now() >= retry; ++attempt)
  {
    try
    {
      if (!placeOnDevice(the_scene))
        break;
      struct Answer
      {
        Result result;
        std::string name;
        std::string warning;
      };
      const auto answer = std::make_shared<Answer>();
      run(
          [slot = device, answer, work]
          {
            answer->result = work(*slot->checker);
            answer->name = slot->checker->deviceName();
            answer->warning = slot->checker->deviceWarning();
          },
          seconds_per_call);
      cpu.reset();
      answered_by(false);
      noteStatus(answer->name, answer->warning);
      return std::move(answer->result);
    }
    catch (const DeviceLost& error)
    {
      noteLoss(error.what());
      if (attempt == kAttempts)
        useCpu(error.what());
    }
    catch (const Error&)
    {
      throw;
    }
    catch (...)
    {
      dropDevice();  // the state of the checker is unknown after this exception
      throw;
    }
  }
  placeOnCpu(the_scene);
  answered_by(true);
  return work(*cpu);
}

ResilientChecker::ResilientChecker(std::shared_ptr<const PlanningScene> scene, Make device, Make cpu,
                                   const ResilientOptions& options, Opening opening)
  : impl_(std::make_unique<Impl>(std::move(device), std::move(cpu), options))
{
  requireRobot(scene);
  impl_->seconds_per_call = options.device_seconds * (1.0 + millionTriangles(*scene));
  if (opening == Opening::AtStart)
    impl_->openDevice(scene, kNoLimit);
  else
    impl_->request<bool>(scene, [](StateChecker&) { return true; });
  impl_->scene = std::move(scene);
}

ResilientChecker::~ResilientChecker()
{
  impl_->dropDevice();
}

void ResilientChecker::setScene(std::shared_ptr<const PlanningScene> scene)
{
  requireRobot(scene);
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  impl_->request<bool>(scene, [](StateChecker&) { return true; });
  impl_->scene = std::move(scene);
}

BatchResult ResilientChecker::check(const double* states, std::size_t count, const std::string& group,
                                    const JointNeighbourhood* around)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  BatchResult result;
  if (impl_->hasLimit())
  {
    const RobotModel& robot = *impl_->scene->robot;
    validateStates(robot, states, count);
    if (around)
      validateNeighbourhood(robot, *around, count);
    // The request owns all objects that it uses, see AbandonableThread.
    const auto rows = std::make_shared<const std::vector<double>>(states, states + count * robot.variables().size());
    const auto neighbourhood = around ? std::make_shared<const JointNeighbourhood>(*around) : nullptr;
    result = impl_->request<BatchResult>(impl_->scene, [=](StateChecker& checker)
                                         { return checker.check(rows->data(), count, group, neighbourhood.get()); });
  }
  else
  {
    result = impl_->request<BatchResult>(
        impl_->scene, [&](StateChecker& checker) { return checker.check(states, count, group, around); });
  }
  if (impl_->answered_by_cpu)
  {
    const std::lock_guard<std::mutex> status_lock(impl_->status_mutex);
    ++impl_->history.batches_on_cpu;
  }
  return result;
}

SceneReport ResilientChecker::report(const std::string& group)
{
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->request<SceneReport>(impl_->scene, [group](StateChecker& checker) { return checker.report(group); });
}

std::string ResilientChecker::deviceName() const
{
  const std::lock_guard<std::mutex> lock(impl_->status_mutex);
  return impl_->history.on_cpu ? "CPU" : impl_->device_name;
}

std::string ResilientChecker::deviceWarning() const
{
  const std::lock_guard<std::mutex> lock(impl_->status_mutex);
  return impl_->history.on_cpu ? "" : impl_->device_warning;
}

DeviceHistory ResilientChecker::history() const
{
  const std::lock_guard<std::mutex> lock(impl_->status_mutex);
  return impl_->history;
}
}  // namespace gpu_planning_scene::core
