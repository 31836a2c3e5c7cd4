#include "collision/checkers/abandonable_thread.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

namespace gpu_planning_scene::core
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
      std::function<void()> taken = std::exchange(job, nullptr);
      lock.unlock();
      std::exception_ptr thrown;
      try
      {
        taken();
      }
      catch (...)
      {
        thrown = std::current_exception();
      }
      taken = nullptr;  // destroys the job's objects on this thread, before the next job
      lock.lock();
      error = std::move(thrown);  // moved, so that only the caller owns the exception
      done = true;
      ended.notify_one();
    }
  }

  std::mutex mutex;  // guards all members below except the thread
  std::condition_variable wake;
  std::condition_variable ended;
  std::function<void()> job;  // the next job; there is at most one, because the caller waits for each job
  bool done = false;          // the last job has ended
  std::exception_ptr error;   // exception that the last job threw
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
    throw std::logic_error("the thread has been given up and takes no more jobs");
  std::unique_lock<std::mutex> lock(queue_->mutex);
  queue_->job = std::move(job);
  queue_->done = false;
  queue_->wake.notify_one();
  if (!queue_->ended.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return queue_->done; }))
  {
    queue_->stopping = true;  // the thread exits if the job ends after all
    lock.unlock();
    queue_->thread.detach();
    queue_.reset();
    return false;
  }
  const std::exception_ptr error = std::exchange(queue_->error, nullptr);
  lock.unlock();
  if (error)
    std::rethrow_exception(error);
  return true;
}
}  // namespace gpu_planning_scene::core
