#pragma once

#include <cstddef>

namespace gpu_planning_scene
{
/// Bytes of memory that this process uses.
std::size_t residentMemory();

/// Refuses what would take more memory while the process uses more than its bound. (A bound by the system, as RLIMIT_AS
/// is, would not do: drivers map much more than they use.)
class MemoryGuard
{
 public:
  /// 0: 80 % of the machine's.
  explicit MemoryGuard(std::size_t most_bytes);
  /// Throws Error over the bound.
  void require() const;

 private:
  const std::size_t most_;
};
}  // namespace gpu_planning_scene
