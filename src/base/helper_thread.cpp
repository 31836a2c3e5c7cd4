#include "base/helper_thread.h"

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

struct Start
{
  std::function<void()> work;
  std::optional<cpu_set_t> cores;  // on which the thread may run after its start
};

void* run(void* argument)
{
  const std::unique_ptr<Start> start(static_cast<Start*>(argument));
  if (start->cores)
    sched_setaffinity(0, sizeof(*start->cores), &*start->cores);
  start->work();
  return nullptr;
}

/// Attributes of a thread that starts on another core than the calling thread.
class Elsewhere
{
 public:
  explicit Elsewhere(const std::optional<cpu_set_t>& cores)
  {
    pthread_attr_init(&attributes_);
    const int here = sched_getcpu();
    if (!cores || here < 0 || !CPU_ISSET(here, &*cores))
      return;
    cpu_set_t others = *cores;
    CPU_CLR(here, &others);
    pthread_attr_setaffinity_np(&attributes_, sizeof(others), &others);
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
  auto start = std::make_unique<Start>(Start{std::move(work), severalCores()});
  const Elsewhere elsewhere(start->cores);
  if (const int error = pthread_create(&thread_, elsewhere.attributes(), run, start.get()); error != 0)
    throw std::system_error(error, std::generic_category(), "no thread can be started");
  start.release();  // the thread deletes it
}

HelperThread::~HelperThread()
{
  pthread_join(thread_, nullptr);
}
}  // namespace gpu_planning_scene::core
