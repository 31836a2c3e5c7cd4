#include "gpu/gl_thread.h"

#include <utility>

#include "base/short_slices.h"
#include "gpu/gl_check.h"

namespace gpu_planning_scene::core
{
GlThread::GlThread(const std::string& device_selector)
{
  std::promise<Device> started;
  std::future<Device> device = started.get_future();
  thread_ = std::thread([this, &device_selector, &started] { serve(device_selector, started); });
  try
  {
    device_ = device.get();
  }
  catch (...)
  {
    thread_.join();
    throw;
  }
}

GlThread::~GlThread()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

std::future<void> GlThread::start(std::function<void()> job)
{
  std::packaged_task<void()> task(
      [job = std::move(job)]
      {
        try
        {
          job();
        }
        catch (...)
        {
          refuseLostContext();  // a reset is then the true cause
          throw;
        }
        refuseLostContext();
      });
  std::future<void> done = task.get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    jobs_.push(std::move(task));
  }
  wake_.notify_one();
  return done;
}

void GlThread::serve(const std::string& device_selector, std::promise<Device>& started)
{
  runInShortSlices();
  std::unique_ptr<EglContext> context;
  try
  {
    context = std::make_unique<EglContext>(device_selector);
  }
  catch (...)
  {
    started.set_exception(std::current_exception());
    return;
  }
  started.set_value(context->device());
  while (true)
  {
    std::packaged_task<void()> job;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
      if (jobs_.empty())
        return;
      job = std::move(jobs_.front());
      jobs_.pop();
    }
    job();
  }
}
}  // namespace gpu_planning_scene::core
