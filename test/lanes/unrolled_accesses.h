#pragma once

#include <string>
#include <vector>

namespace gpu_planning_scene::core
{
/// Finds accesses to arrays without a size, in storage buffers, that a compiler may turn into accesses to constant
/// places: in a loop with constant bounds, with an index of constants and loop counters only. NVIDIA's compiler unrolls
/// such a loop and then refuses the shader: "C5025: lvalue in array access too complex; possible array index out of
/// bounds". Also finds calls, in such a loop, of a function whose parameters become such an index. `shader`: the text
/// of a shader with its includes. Returns one line for each access: "line N: NAME[INDEX]".
std::vector<std::string> unrolledAccesses(const std::string& shader);
}  // namespace gpu_planning_scene::core
