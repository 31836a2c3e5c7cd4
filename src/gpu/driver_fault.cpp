#include "gpu/driver_fault.h"

namespace gpu_planning_scene::core
{
std::string driverFault(const std::string& renderer)
{
  // Measured with Mesa 22.3.6 on lavapipe (docs/gpu.md). The cause is not known.
  if (renderer.rfind("zink", 0) == 0)
    return "the driver of '" + renderer +
           "' computes wrong answers (zink translates OpenGL to Vulkan); use the OpenGL driver of the GPU's vendor, or "
           "the device 'cpu'";
  return "";
}
}  // namespace gpu_planning_scene::core
