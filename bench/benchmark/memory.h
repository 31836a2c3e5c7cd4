#pragma once

#include <memory>
#include <string>

#include "gpu/egl_context.h"

namespace gpu_planning_scene::core::benchmark
{
/// How much memory this process came to hold, at its peak, beyond what it held at first; in MiB.
class HostMemory
{
 public:
  HostMemory();
  /// Not a number where the system does not tell.
  double peak() const;

 private:
  double at_first_;
};

/// What a GPU's driver tells of its memory (GL_NVX_gpu_memory_info).
class DeviceMemory
{
 public:
  explicit DeviceMemory(const std::string& device);
  /// Of all processes, in MiB; not a number where the driver does not tell.
  double used() const;

 private:
  std::unique_ptr<EglContext> context_;
  bool known_;
};
}  // namespace gpu_planning_scene::core::benchmark
