#pragma once

#include <cstdint>
#include <vector>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::literature
{
/// Connected triangles that lie on their convex hull, as indices into the mesh. The hull cuts no other part of the
/// mesh, so the hull of a patch of a solid is a part of this solid.
using SurfacePatch = std::vector<std::uint32_t>;

/// Divides the triangles of a mesh into patches. Lengths below 1e-7 of the size of the mesh count as 0. Takes a time
/// that grows with the square of the triangles of a patch.
std::vector<SurfacePatch> convexPatches(const Mesh& mesh);
}  // namespace gpu_planning_scene::core::literature
