#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// An EGL device that can be asked for an OpenGL 4.5 context without a window.
struct Device
{
  int index = -1;         ///< what `--device INDEX` takes
  std::string renderer;   ///< GL_RENDERER
  std::string version;    ///< GL_VERSION
  bool software = false;  ///< llvmpipe and its like
};

/// Every usable device, in EGL's order. Creates and destroys a context on each.
std::vector<Device> listDevices();
}  // namespace gpu_planning_scene::core
