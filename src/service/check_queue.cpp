#include "service/check_queue.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <system_error>
#include <utility>

// Own method.
namespace gpu_planning_scene::core
{
namespace
{
// After the checker of the second thread could not be made; doubled each time, up to the second number.
constexpr std::chrono::seconds kFirstRest{1};
constexpr std::chrono::seconds kLongestRest{60};
}  // namespace

CheckQueue::CheckQueue(const SceneStore& store, MakeChecker make_checker, const CheckServerOptions& options,
                       std::size_t max_merged_states, const MakeChecker& make_relief)
  : requests_(options, max_merged_states),
    worker_(store, requests_, std::move(make_checker), [this](const CheckStatistics& answered) { count(answered); }),
    relief_(store, requests_, make_relief, [this](const CheckStatistics& answered) { count(answered); }),
    has_relief_(make_relief),
    thread_(),
    relief_thread_()
{
}

CheckQueue::~CheckQueue()
{
  stop();
}

std::future<CheckAnswer> CheckQueue::submit(CheckJob job, std::size_t count)
{
  startThreads();
  return requests_.submit(std::move(job), count);
}

/// Called before a request is queued: if the first thread cannot start, no request waits for it.
void CheckQueue::startThreads()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (requests_.isStopping())
    return;
  if (!thread_.joinable())
    thread_ = std::thread([this] { run(); });
  try
  {
    if (has_relief_ && !relief_thread_.joinable())
      relief_thread_ = std::thread([this] { relieve(); });
  }
  catch (const std::system_error&)
  {
    // The other thread answers all requests.
  }
}

void CheckQueue::refuse()
{
  requests_.stop();
}

void CheckQueue::stop()
{
  refuse();
  std::array<std::thread, 2> threads;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    threads[0].swap(thread_);
    threads[1].swap(relief_thread_);
  }
  for (std::thread& thread : threads)
    if (thread.joinable())
      thread.join();
  worker_.close();
  relief_.close();
}

void CheckQueue::run()
{
  for (CheckBatch batch = requests_.takeOldest(); !batch.empty(); batch = requests_.takeOldest())
    worker_.answer(batch);
}

void CheckQueue::relieve()
{
  std::chrono::steady_clock::time_point rest;
  std::chrono::seconds next_rest = kFirstRest;
  while (std::optional<CheckBatch> batch = requests_.takeOverdue([this] { return relief_.isReady(); }, rest))
    if (!batch->empty())
      relief_.answer(*batch);
    else
      try
      {
        relief_.prepare();
        next_rest = kFirstRest;
      }
      catch (...)
      {
        // The first thread answers the requests, or says what is wrong with the scene.
        rest = std::chrono::steady_clock::now() + next_rest;
        next_rest = std::min(2 * next_rest, kLongestRest);
      }
}

void CheckQueue::count(const CheckStatistics& answered)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  answered_ += answered;
}

CheckStatistics CheckQueue::statistics() const
{
  CheckStatistics statistics = requests_.statistics();
  const std::lock_guard<std::mutex> lock(mutex_);
  return statistics += answered_;
}
}  // namespace gpu_planning_scene::core
