#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "collision/proofs/stopped.h"
#include "collision/trees/cpu_tree.h"

namespace gpu_planning_scene::core
{
/// A cube inside the solid of a shape.
struct SolidCell
{
  Eigen::Vector3d center;
  double depth;  ///< metres: distance of the centre from the triangles of the surface
};

/// A grid of cubes.
struct CubeGrid
{
  Eigen::Vector3d origin;  ///< a corner of the first cube
  double cell;             ///< metres: edge length of the cubes
  Eigen::Vector3i count;   ///< number of cubes along each axis

  /// The cube that contains a point; points outside the grid belong to the nearest cube.
  Eigen::Vector3i cubeOf(const Eigen::Vector3d& point) const
  {
    const Eigen::Vector3i cube = ((point - origin) / cell).array().floor().cast<int>();
    return cube.cwiseMax(0).cwiseMin(count - Eigen::Vector3i::Ones());
  }
  std::size_t numberOf(const Eigen::Vector3i& cube) const
  {
    return (static_cast<std::size_t>(cube.z()) * static_cast<std::size_t>(count.y()) +
            static_cast<std::size_t>(cube.y())) *
               static_cast<std::size_t>(count.x()) +
           static_cast<std::size_t>(cube.x());
  }
  Eigen::Vector3d centerOf(const Eigen::Vector3i& cube) const
  {
    return origin + cell * (cube.cast<double>().array() + 0.5).matrix();
  }

  /// Calls `visit` with each cube from `first` to `last`.
  template <class Visit>
  void each(const Eigen::Vector3i& first, const Eigen::Vector3i& last, const Visit& visit) const
  {
    for (int z = first.z(); z <= last.z(); ++z)
      for (int y = first.y(); y <= last.y(); ++y)
        for (int x = first.x(); x <= last.x(); ++x)
          visit(Eigen::Vector3i(x, y, z));
  }
};

/// The surface and the solid of a shape in small parts, in the shape's frame.
struct ShapeSamples
{
  std::vector<Triangle> pieces;         ///< small triangles that together are the surface
  std::vector<Eigen::Vector3d> points;  ///< of the surface, at most one in each cube of a grid
  std::vector<SolidCell> cells;         ///< cubes of the grid that no part of the surface enters
  /// Points inside the shape, by its solid or, without a solid, by its winding number.
  std::vector<SolidCell> inside;
  CubeGrid grid;
};

/// Cuts a shape into parts. All points of its solid that are in none of the cells are within sqrt(3) * grid.cell of
/// the surface. Throws ProofsStopped.
ShapeSamples samplesOf(const CpuTree& tree, const Stopped& stopped = {});

/// Whether the shape has a solid: it is a primitive, or a mesh with a part that bounds a solid.
bool hasSolid(const CpuTree& tree);

/// Whether a point is in the shape's solid. Points on the surface may count as outside.
bool insideSolid(const CpuTree& tree, const Eigen::Vector3d& point);

/// The distance of a point from the triangles of the surface.
double distanceFromSurface(const CpuTree& tree, const Eigen::Vector3d& point);
}  // namespace gpu_planning_scene::core
