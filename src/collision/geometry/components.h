#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// A connected component of a mesh, in the mesh's frame.
struct Component
{
  Eigen::Vector3d point;       ///< one of its vertices
  Eigen::AlignedBox3d bounds;  ///< of its vertices
  bool closed;                 ///< bounds a solid, see MeshComponents
};

/// A mesh taken apart: vertices at equal places are one; triangles that share a vertex are connected; triangles that
/// name a place twice connect, but bound nothing. A component is closed if each edge of its other triangles belongs to
/// exactly two of them, in opposite directions. The closed components together bound a solid: the points around which
/// their winding number is not 0.
struct MeshComponents
{
  std::vector<Component> components;
  std::vector<std::uint8_t> bounds_solid;  ///< one per triangle: 1 if it counts for the winding number
  bool hasSolid() const;
};

MeshComponents findComponents(const Mesh& mesh);
}  // namespace gpu_planning_scene::core
