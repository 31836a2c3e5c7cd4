#include "benchmark/memory.h"

#include <fstream>
#include <limits>

#include <malloc.h>

#include <epoxy/gl.h>

namespace gpu_planning_scene::core::benchmark
{
namespace
{
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kKibInMib = 1024.0;

/// A line of /proc/self/status, in MiB.
double statusOf(const std::string& name)
{
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == name + ":")
    {
      double kib = kUnknown;
      status >> kib;
      return kib / kKibInMib;
    }
  return kUnknown;
}
}  // namespace

HostMemory::HostMemory()
{
  malloc_trim(0);                                 // memory freed earlier must not hide later allocations
  std::ofstream("/proc/self/clear_refs") << "5";  // resets the peak
  at_first_ = statusOf("VmRSS");
}

double HostMemory::peak() const
{
  return statusOf("VmHWM") - at_first_;
}

DeviceMemory::DeviceMemory(const std::string& device)
  : context_(std::make_unique<EglContext>(device)), known_(epoxy_has_gl_extension("GL_NVX_gpu_memory_info"))
{
}

double DeviceMemory::used() const
{
  if (!known_)
    return kUnknown;
  GLint total = 0;
  GLint available = 0;
  glGetIntegerv(GL_GPU_MEMORY_INFO_TOTAL_AVAILABLE_MEMORY_NVX, &total);
  glGetIntegerv(GL_GPU_MEMORY_INFO_CURRENT_AVAILABLE_VIDMEM_NVX, &available);
  return (total - available) / kKibInMib;
}
}  // namespace gpu_planning_scene::core::benchmark
