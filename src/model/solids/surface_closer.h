#pragma once

#include <vector>

#include <Eigen/Core>

#include "gpu_planning_scene/solids.h"
#include "model/solids/hole_filling.h"
#include "model/solids/mesh_edges.h"
#include "model/solids/welded_triangles.h"

namespace gpu_planning_scene::core
{
/// The triangles of a mesh, as places, with the triangles that close them.
struct ClosedSurface
{
  std::vector<Corners> triangles;  ///< those of the input in their order, some of them turned; then the added ones
  std::vector<TriangleRole> roles;
  std::vector<std::uint32_t> cycles;  ///< numbers from 1; the triangles of one have no boundary; 0: in none
  std::vector<MeshPart> parts;        ///< none is Closed
  std::vector<MeshPart> uncertain;    ///< of these closed parts, more may be inside than what counts as inside
  std::vector<std::uint32_t> open;    ///< the numbers of the input's triangles in parts of the kind Surface
};

/// How to close the parts of a surface.
struct Closing
{
  double tolerance;  ///< metres, for welding and seams
  WeldedCorners welded;
  bool fills_holes;  ///< false: a part with a hole remains a surface
  ConnectedBy connected;
  double most_share;  ///< a part remains a surface if the triangles that close it have more than this share of its area
};

/// Steps 2 and 3 of solidMeshOf for triangles of a mesh. `budget`: of the mesh.
ClosedSurface closeSurface(const std::vector<Eigen::Vector3d>& points, const std::vector<Corners>& triangles,
                           const Closing& closing, FillingBudget& budget);
}  // namespace gpu_planning_scene::core
