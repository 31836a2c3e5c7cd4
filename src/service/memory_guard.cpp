#include "service/memory_guard.h"

#include <fstream>
#include <string>

#include <malloc.h>
#include <unistd.h>

#include "base/text/memory_text.h"
#include "service/service_errors.h"

namespace gpu_planning_scene::core
{
namespace
{
std::size_t pageSize()
{
  return static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::size_t machineMemory()
{
  return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * pageSize();
}
}  // namespace

std::size_t residentMemory()
{
  std::ifstream file("/proc/self/statm");
  std::size_t total = 0;
  std::size_t resident = 0;
  file >> total >> resident;
  return resident * pageSize();
}

MemoryGuard::MemoryGuard(std::size_t max_bytes) : max_(max_bytes != 0 ? max_bytes : machineMemory() / 5 * 4) {}

void MemoryGuard::require() const
{
  if (residentMemory() <= max_)
    return;
  {
    // malloc_trim takes long on a fragmented heap, so it gets at most about a tenth of the time.
    const std::lock_guard<std::mutex> lock(mutex_);
    const Clock::time_point begin = Clock::now();
    if (begin >= next_return_)
    {
      malloc_trim(0);
      const Clock::time_point end = Clock::now();
      next_return_ = end + 10 * (end - begin);
    }
  }
  const std::size_t used = residentMemory();
  if (used > max_)
    throw OutOfMemory("out of memory: the process uses " + megabytes(used) + ", and the limit is " + megabytes(max_) +
                      " (limits/memory); send a smaller request, or remove objects");
}
}  // namespace gpu_planning_scene::core
