#pragma once

#include <stdexcept>
#include <string>

#include "lanes/simulator.h"

namespace lanes
{
/// A shader that cannot be translated or compiled. This is no fault of the device.
struct TranslationError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Compiles a complete shader (with #version and definitions) as C++ and loads it. Libraries are kept in the folder
/// $GPS_LANES_CACHE under a hash of the shader and of the sources of kernel.h. Throws TranslationError with the
/// compiler's message.
Simulator::Program loadKernel(const std::string& shader);
}  // namespace lanes
