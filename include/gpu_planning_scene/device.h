#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// An EGL device that supports an OpenGL 4.5 context without a window.
struct Device
{
  int index = -1;         ///< the value for `--device INDEX`
  std::string renderer;   ///< GL_RENDERER
  std::string version;    ///< GL_VERSION
  bool software = false;  ///< true for llvmpipe and other software renderers
};

/// Lists all usable devices, in EGL's order. To test a device, the function creates and destroys a context on it.
/// Throws Error if the EGL or OpenGL library is missing.
std::vector<Device> listDevices();
}  // namespace gpu_planning_scene::core
