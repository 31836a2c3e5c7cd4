#pragma once

#include <cstdint>
#include <string>

namespace gpu_planning_scene::core
{
/// Linked programs on disk, so that a second start compiles nothing: in $XDG_CACHE_HOME/gpu_planning_scene, else
/// ~/.cache/gpu_planning_scene; GPU_PLANNING_SCENE_PROGRAM_CACHE=off switches it off. An entry is used only where the
/// whole source text and the driver (vendor, renderer, version) are those that it was made of and its checksum holds.
/// Whatever goes wrong, the program is compiled instead: only the time differs. Both on the context's thread.

/// A new linked program, or 0 if there is none to be had.
std::uint32_t loadCachedProgram(const std::string& source);

/// Keeps a linked program for the next start. The oldest entries go where all together are more than 64 MiB.
void cacheProgram(std::uint32_t program, const std::string& source);
}  // namespace gpu_planning_scene::core
