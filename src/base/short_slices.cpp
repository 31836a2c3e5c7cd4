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

// The kernel's sched_attr, which glibc 2.36 does not declare, and whose header clashes with <sched.h> of later ones.
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
  own.flags = kResetOnFork;
  own.runtime = kShortest;
  // If the system forbids it, the thread only waits longer.
  static_cast<void>(syscall(SYS_sched_setattr, 0, &own, 0));
}
}  // namespace gpu_planning_scene::core
