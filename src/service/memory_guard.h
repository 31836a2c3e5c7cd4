#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>

namespace gpu_planning_scene::core
{
/// Bytes of memory that this process uses.
std::size_t residentMemory();

/// Refuses what would take more memory while the process uses more than its bound. What is free inside the process is
/// given back to the system before that. (A bound by the system, as RLIMIT_AS
/// is, would not do: drivers map much more than they use.)
class MemoryGuard
{
 public:
  /// 0: 80 % of the machine's.
  explicit MemoryGuard(std::size_t most_bytes);
  /// Throws Error over the bound.
  void require() const;

 private:
  using Clock = std::chrono::steady_clock;

  const std::size_t most_;
  mutable std::mutex mutex_;                 // of the one below
  mutable Clock::time_point next_return_{};  // when free memory is given back again
};
}  // namespace gpu_planning_scene::core
