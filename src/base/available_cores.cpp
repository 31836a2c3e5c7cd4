#include "base/available_cores.h"

#include <algorithm>
#include <thread>

#include <sched.h>
#include <unistd.h>

namespace gpu_planning_scene::core
{
std::size_t availableCores()
{
  // Asking the system takes longer than checking a state.
  static const std::size_t cores = []
  {
    cpu_set_t set;
    if (sched_getaffinity(getpid(), sizeof(set), &set) == 0)  // fails on machines with more than 1024 cores
      return static_cast<std::size_t>(std::max(1, CPU_COUNT(&set)));
    return static_cast<std::size_t>(std::max(1U, std::thread::hardware_concurrency()));
  }();
  return cores;
}
}  // namespace gpu_planning_scene::core
