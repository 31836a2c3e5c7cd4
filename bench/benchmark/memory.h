#pragma once

#include <memory>
#include <string>

#include "gpu/egl_context.h"

namespace gpu_planning_scene::core::benchmark
{
/// Peak memory of this process since construction, minus its memory at construction; in MiB.
class HostMemory
{
 public:
  HostMemory();
  /// NaN if the system does not report it.
  double peak() const;

 private:
  double at_first_;
};

/// GPU memory as the driver reports it (GL_NVX_gpu_memory_info).
class DeviceMemory
{
 public:
  explicit DeviceMemory(const std::string& device);
  /// Memory used by all processes, in MiB; NaN if the driver does not report it.
  double used() const;

 private:
  std::unique_ptr<EglContext> context_;
  bool known_;
};
}  // namespace gpu_planning_scene::core::benchmark
