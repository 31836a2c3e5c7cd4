#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lanes/simulator.h"

namespace lanes
{
/// Replaces the OpenGL functions that src/gpu calls by functions that use `device()`, for the rest of the process. The
/// entry points of libepoxy are variables, so the code of the project runs unchanged and needs no context.
void replaceOpenGl();

/// The simulated device behind the replaced functions. It executes commands later than they are given; what the host
/// does to mapped memory, and uploads to buffers with GL_DYNAMIC_STORAGE_BIT, happens at once.
Simulator& device();

/// The text of each shader that was compiled.
const std::vector<std::string>& compiledShaders();

/// Programs that are only recorded and do nothing when they run; for tests of the shaders' texts.
void recordOnly();

/// Each later memory barrier before a command of this kind lacks these bits. `command`: dispatch, indirect dispatch,
/// upload (also a copy from a mapped buffer), download, clear, copy or readback (a copy to a mapped buffer); empty: all
/// kinds.
void ignoreBarrierBits(std::uint32_t bits, const std::string& command);
}  // namespace lanes
