#pragma once

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
/// An operation needs more memory than the device has left. Unlike the other errors of OpenGL, a large scene can cause
/// this one.
class OutOfDeviceMemory : public Error
{
 public:
  using Error::Error;
};

/// Throws if OpenGL has recorded an error on the current context since the last call: OutOfDeviceMemory if memory ran
/// out, else DeviceLost. `where` names the operation.
void checkGl(const char* where);

/// Throws DeviceLost if the current context was reset. Its results are then unreliable.
void refuseLostContext();
}  // namespace gpu_planning_scene::core
