#pragma once

#include <memory>
#include <string>

#include "gpu_planning_scene/device.h"

namespace gpu_planning_scene::core
{
/// An OpenGL 4.5 core context without a window or surface, on one EGL device. It is current on the thread that made it
/// and must be used and destroyed there.
class EglContext
{
 public:
  /// `selector`: "auto" (the first hardware device, else the first software one), "software", an index of
  /// listDevices(), or part of a renderer's name (case-insensitive). Throws Error with a list of the devices if none
  /// fits.
  explicit EglContext(const std::string& selector);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  const Device& device() const { return device_; }

 private:
  Device device_;
  void* display_ = nullptr;  // EGLDisplay
  void* context_ = nullptr;  // EGLContext
};
}  // namespace gpu_planning_scene::core
