#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "collision/exact/cpu_tree.h"

namespace gpu_planning_scene::core
{
/// A cube inside the solid of a shape.
struct SolidCell
{
  Eigen::Vector3d center;
  double depth;  ///< metres: approximate distance of the centre from the surface
};

/// The surface and the solid of a shape in small parts, in the shape's frame.
struct ShapeSamples
{
  std::vector<Triangle> pieces;         ///< triangles with edges of at most `cell`; together they are the surface
  std::vector<Eigen::Vector3d> points;  ///< of the surface, at most one in each cube of a grid
  std::vector<SolidCell> cells;         ///< cubes of edge length `cell` that no part of the surface enters
  /// Points inside the shape, by its solid or, without a solid, by its winding number, with their approximate distance
  /// from the surface.
  std::vector<SolidCell> inside;
  double cell;  ///< metres
};

/// Cuts a shape into parts. All points of its solid that are in none of the cells are within sqrt(3) * cell of the
/// surface.
ShapeSamples samplesOf(const CpuTree& tree);

/// Whether the shape has a solid: it is a primitive, or a mesh with a closed component.
bool hasSolid(const CpuTree& tree);

/// Whether a point is in the shape's solid. Points on the surface may count as outside.
bool insideSolid(const CpuTree& tree, const Eigen::Vector3d& point);

/// The distance of a point from the triangles of the surface.
double distanceFromSurface(const CpuTree& tree, const Eigen::Vector3d& point);
}  // namespace gpu_planning_scene::core
