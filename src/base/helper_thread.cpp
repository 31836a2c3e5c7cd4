#include "base/helper_thread.h"

#include <cerrno>
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

void* HelperThread::run(void* helper)
{
  auto& self = *static_cast<HelperThread*>(helper);
  self.work_();
  while (!self.may_end_)
    sched_yield();
  return nullptr;
}

HelperThread::HelperThread(std::function<void()> work) : work_(std::move(work)), thread_()
{
  // Where the system forbids it, it is tried only once: before glibc 2.34, each such pthread_create loses a stack.
  static std::atomic<bool> may_choose_cores{true};
  const std::optional<cpu_set_t> cores = may_choose_cores ? severalCores() : std::nullopt;
  int error = cores ? pthread_create(&thread_, Elsewhere(*cores).attributes(), run, this) : EINVAL;
  if (error == 0)
    // Not by the thread itself: while it waits for a busy core, an idle one must be able to take it. The thread cannot
    // have ended: in place of a thread that has ended, this would change the calling one.
    pthread_setaffinity_np(thread_, sizeof(*cores), &*cores);
  else
  {
    if (error == EPERM || error == EACCES || error == ENOSYS)
      may_choose_cores = false;
    error = pthread_create(&thread_, nullptr, run, this);
  }
  may_end_ = true;
  if (error != 0)
    throw std::system_error(error, std::generic_category(), "no thread can be started");
}

HelperThread::~HelperThread()
{
  pthread_join(thread_, nullptr);
}
}  // namespace gpu_planning_scene::core
