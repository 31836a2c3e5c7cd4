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
  Eigen::Vector3d point;       ///< a vertex of the component
  Eigen::AlignedBox3d bounds;  ///< of its vertices
  bool closed;                 ///< the component bounds a solid, see MeshComponents
};

/// The connected components of a mesh. Vertices at equal places count as one vertex. Triangles that share a vertex are
/// connected. A triangle that names the same place twice connects its vertices, but it bounds nothing. A component is
/// closed if each edge of its other triangles belongs to exactly two of them, in opposite directions. The closed
/// components together bound a solid: all points with a winding number that is not 0.
struct MeshComponents
{
  std::vector<Component> components;
  std::vector<std::uint8_t> bounds_solid;  ///< one per triangle: 1 if the triangle counts for the winding number
  bool hasSolid() const;
};

MeshComponents findComponents(const Mesh& mesh);
}  // namespace gpu_planning_scene::core
