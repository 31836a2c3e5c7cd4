#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>

namespace gpu_planning_scene::core
{
/// Resident memory of this process in bytes.
std::size_t residentMemory();

/// Refuses operations that need more memory while the process uses more than its bound. Before that, free heap memory
/// is returned to the system. The system's own bound, RLIMIT_AS, is not suitable: it counts address space, and drivers
/// map much more address space than they use.
class MemoryGuard
{
 public:
  /// `max_bytes`: the bound; 0: 80 % of the machine's memory.
  explicit MemoryGuard(std::size_t max_bytes);
  /// Throws OutOfMemory if the process uses more than the bound.
  void require() const;

 private:
  using Clock = std::chrono::steady_clock;

  const std::size_t max_;
  mutable std::mutex mutex_;                 // guards next_return_
  mutable Clock::time_point next_return_{};  // earliest time to return free memory again
};
}  // namespace gpu_planning_scene::core
