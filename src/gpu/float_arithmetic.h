#pragma once

#include <string>

namespace gpu_planning_scene::core
{
/// Tests whether the device's float32 fulfils the assumptions of docs/error_bounds.md, with a shader that is compiled
/// like all others. Two-sum (Knuth 1969) and two-product (Dekker 1971) must be exact, and `precise` expressions must
/// not be contracted. Lengths must be right to 4 units of 2^-23, and dot products to 3. Comparisons with NaN must be
/// false. Returns one line that describes the first fault, or an empty string. Used on the context's thread.
std::string findFloatFault(const std::string& shader_folder);

/// The same test for double precision, which is used for link poses. Operations must be right to 2^-50 of their result,
/// and results must be rounded to the nearest float.
std::string findDoubleFault(const std::string& shader_folder);

/// Finds out whether the driver emulates double precision by integer operations, as Intel's does for Gen11 and Gen12.
/// One operation is then some hundred instructions, and to compile a robot's kinematics takes hours. Returns one line,
/// or an empty string. Used on the context's thread.
std::string findEmulatedDouble(const std::string& shader_folder);
}  // namespace gpu_planning_scene::core
