#pragma once

namespace gpu_planning_scene::core
{
/// A hash of the source code that makes proofs, without comments: proofs on disk are used only by the code that made
/// them. The build sets it, see cmake/proof_sources.cmake.
extern const char* const kProofSources;
}  // namespace gpu_planning_scene::core
