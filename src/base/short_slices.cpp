#include "base/short_slices.h"

#include <cstdint>

#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::uint64_t kShortest = 100'000;  // nanoseconds; Linux allows no shorter slices

// The kernel's sched_attr. glibc declares it since 2.41, and the kernel's header declares sched_param a second time.
struct Attributes
{
  std::uint32_t size;
  std::uint32_t policy;
  std::uint64_t flags;
  std::int32_t nice;
  std::uint32_t priority;
  std::uint64_t runtime;  // of a thread without real-time policy: its slice
  std::uint64_t deadline;
  std::uint64_t period;
};
constexpr std::uint64_t kResetOnFork = 1;
}  // namespace

void runInShortSlices()
{
  Attributes own{};
  if (syscall(SYS_sched_getattr, 0, &own, sizeof(own), 0) != 0 || own.policy != SCHED_OTHER)
    return;
  const bool has_slices = own.runtime != 0;  // since Linux 6.12
  // kResetOnFork would give the threads of a thread with a negative nice value the value 0.
  if (!has_slices || own.nice < 0)
    return;
  own.flags = kResetOnFork;
  own.runtime = kShortest;
  // If the system forbids it, the thread only waits longer.
  static_cast<void>(syscall(SYS_sched_setattr, 0, &own, 0));
}
}  // namespace gpu_planning_scene::core
