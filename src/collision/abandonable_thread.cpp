#include "collision/abandonable_thread.h"

#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

namespace gpu_planning_scene
{
struct AbandonableThread::Queue
{
  void serve()
  {
    std::unique_lock<std::mutex> lock(mutex);
    while (true)
    {
      wake.wait(lock, [this] { return stopping || job; });
      if (!job)
        return;
      std::packaged_task<void()> taken = std::move(*job);
      job.reset();
      lock.unlock();
      taken();
      taken = {};  // what it holds ends here, on this thread, before the next job
      lock.lock();
    }
  }

  std::mutex mutex;
  std::condition_variable wake;
  std::optional<std::packaged_task<void()>> job;  // that waits; each is waited for, so there is never a second one
  bool stopping = false;
  std::thread thread;
};

AbandonableThread::AbandonableThread() : queue_(std::make_shared<Queue>())
{
  queue_->thread = std::thread([queue = queue_] { queue->serve(); });
}

AbandonableThread::~AbandonableThread()
{
  if (givenUp())
    return;
  {
    const std::lock_guard<std::mutex> lock(queue_->mutex);
    queue_->stopping = true;
  }
  queue_->wake.notify_one();
  queue_->thread.join();
}

bool AbandonableThread::run(std::function<void()> job, double seconds)
{
  if (givenUp())
    throw std::logic_error("a job for a thread that was given up");
  std::packaged_task<void()> task(std::move(job));
  std::future<void> done = task.get_future();
  {
    const std::lock_guard<std::mutex> lock(queue_->mutex);
    queue_->job = std::move(task);
  }
  queue_->wake.notify_one();
  if (done.wait_for(std::chrono::duration<double>(seconds)) != std::future_status::ready)
  {
    {
      const std::lock_guard<std::mutex> lock(queue_->mutex);
      queue_->stopping = true;  // should the job end after all
    }
    queue_->thread.detach();
    queue_.reset();
    return false;
  }
  done.get();
  return true;
}
}  // namespace gpu_planning_scene
