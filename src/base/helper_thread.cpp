#include "base/helper_thread.h"

#include <cerrno>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include <sched.h>

namespace gpu_planning_scene::core
{
namespace
{
/// The cores on which the calling thread may run. Null if they are not known (on machines with more than 1024 cores) or
/// if there is only one.
std::optional<cpu_set_t> severalCores()
{
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof(cores), &cores) != 0 || CPU_COUNT(&cores) < 2)
    return std::nullopt;
  return cores;
}

void* run(void* work)
{
  (*std::unique_ptr<std::function<void()>>(static_cast<std::function<void()>*>(work)))();
  return nullptr;
}

/// Attributes of a thread that starts on another core than the calling thread.
class Elsewhere
{
 public:
  explicit Elsewhere(cpu_set_t cores)
  {
    pthread_attr_init(&attributes_);
    if (const int here = sched_getcpu(); here >= 0)
      CPU_CLR(here, &cores);
    pthread_attr_setaffinity_np(&attributes_, sizeof(cores), &cores);
  }
  ~Elsewhere() { pthread_attr_destroy(&attributes_); }
  Elsewhere(const Elsewhere&) = delete;
  Elsewhere& operator=(const Elsewhere&) = delete;

  const pthread_attr_t* attributes() const { return &attributes_; }

 private:
  pthread_attr_t attributes_;
};
}  // namespace

HelperThread::HelperThread(std::function<void()> work) : thread_()
{
  auto own = std::make_unique<std::function<void()>>(std::move(work));
  const std::optional<cpu_set_t> cores = severalCores();
  int error = cores ? pthread_create(&thread_, Elsewhere(*cores).attributes(), run, own.get()) : EINVAL;
  if (error == 0)
    // Not by the thread itself: while it waits for a busy core, an idle one must be able to take it.
    pthread_setaffinity_np(thread_, sizeof(*cores), &*cores);
  else
    // There is only one core, or the system does not let this process choose cores.
    error = pthread_create(&thread_, nullptr, run, own.get());
  if (error != 0)
    throw std::system_error(error, std::generic_category(), "no thread can be started");
  static_cast<void>(own.release());  // the thread deletes it
}

HelperThread::~HelperThread()
{
  pthread_join(thread_, nullptr);
}
}  // namespace gpu_planning_scene::core
