#pragma once

#include <cstdint>
#include <string>

namespace gpu_planning_scene::core
{
/// A cache of linked programs on disk, so that a second start compiles nothing. Its folder is
/// $XDG_CACHE_HOME/gpu_planning_scene, else ~/.cache/gpu_planning_scene. GPU_PLANNING_SCENE_PROGRAM_CACHE=off switches
/// it off. An entry is used only if its source text, its driver (vendor, renderer, version) and its checksum match.
/// After any failure the program is compiled instead, so a failure costs only time. Both functions run on the context's
/// thread.

/// A new linked program, or 0 if the cache has no usable entry.
std::uint32_t loadCachedProgram(const std::string& source);

/// Stores a linked program for the next start. The entries that were used longest ago are removed if all together
/// exceed 64 MiB.
void cacheProgram(std::uint32_t program, const std::string& source);
}  // namespace gpu_planning_scene::core
