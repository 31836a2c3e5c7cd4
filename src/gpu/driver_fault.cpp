#include "gpu/driver_fault.h"

namespace gpu_planning_scene::core
{
std::string driverFault(const std::string& renderer)
{
  // Measured with Mesa 22.3.6 on lavapipe (docs/gpu.md). The cause is not known. Layers above zink put their own names
  // before its name, such as "virgl (zink (...))".
  if (renderer.find("zink") != std::string::npos)
    return "the driver of '" + renderer +
           "' computes wrong answers (zink translates OpenGL to Vulkan); install the GPU vendor's own OpenGL driver, "
           "or choose the device 'cpu'";
  return "";
}
}  // namespace gpu_planning_scene::core
