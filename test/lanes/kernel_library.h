#pragma once

#include <string>

#include "lanes/simulator.h"

namespace lanes
{
/// Compiles a complete shader (with #version and definitions) as C++ and loads it. Libraries are kept in the folder
/// $GPS_LANES_CACHE under a hash of the shader and of the sources of kernel.h. Throws std::runtime_error with the
/// compiler's message.
Simulator::Program loadKernel(const std::string& shader);
}  // namespace lanes
