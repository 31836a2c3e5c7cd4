#pragma once

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
/// What was asked for needs more memory than the device has left. Unlike other errors of OpenGL a scene can cause it.
class OutOfDeviceMemory : public Error
{
 public:
  using Error::Error;
};

/// Throws if OpenGL has recorded an error on the current context since the last call: OutOfDeviceMemory, or else
/// DeviceLost. `where` names the operation.
void checkGl(const char* where);

/// Throws DeviceLost if the current context was reset: nothing that was done with it can be relied on.
void refuseLostContext();
}  // namespace gpu_planning_scene::core
