#pragma once

#include <string>

namespace gpu_planning_scene::core
{
/// Tests the device's float32 for what docs/error_bounds.md assumes, with a kernel that is compiled as all others are:
/// two-sum and two-product exact, nothing contracted where `precise` forbids it, lengths right to 4 units of 2^-23 and
/// dot products to 3, comparisons with no number false. Returns one line that says what is wrong, or an empty string.
/// Used on the context's thread.
std::string findFloatFault(const std::string& shader_folder);

/// The same of double precision, which places links: operations good to 2^-50 of the result, and rounded to float as
/// they should be.
std::string findDoubleFault(const std::string& shader_folder);
}  // namespace gpu_planning_scene::core
