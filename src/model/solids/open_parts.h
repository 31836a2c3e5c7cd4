#pragma once

#include <cstdint>
#include <vector>

#include "gpu_planning_scene/solids.h"
#include "model/solids/mesh_edges.h"
#include "model/solids/welding.h"

namespace gpu_planning_scene::core
{
/// Closes the triangles with the numbers `open`, as far as possible, and adds the parts that they make to `solid`.
/// `diagonal`: of the mesh, in metres. Returns the cycle of each triangle of the mesh, see ClosedSurface.
std::vector<std::uint32_t> closeOpenParts(const std::vector<Corners>& triangles, const Places& places, double diagonal,
                                          std::vector<std::uint32_t> open, SolidMesh& solid);
}  // namespace gpu_planning_scene::core
