#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "model/solids/mesh_edges.h"

namespace gpu_planning_scene::core
{
/// What lies on the two sides of a triangle.
enum class ShellPlace : std::uint8_t
{
  Shell,  ///< the outside, and a chamber
  Wall,   ///< chambers
  Beside  ///< the outside: the triangle bounds nothing, for example in a fin
};

struct OuterShell
{
  std::vector<ShellPlace> places;  ///< of each triangle
  std::vector<bool> turned;        ///< whether the front of a triangle of the shell is on the inside
};

/// The order of triangles that have an edge in common and lie upon one another there. It does not follow from their
/// positions.
enum class SheetOrder
{
  FirstBehind,  ///< the triangle of the first patch is behind the others, as seen from its front
  FirstInFront
};

/// Finds the boundary of what triangles enclose: of all chambers that the outside does not reach across an edge. The
/// triangles of the shell, some of them turned, have no signed boundary. Triangles that cross one another away from
/// common edges can open a chamber, never close one. Corners are indices into `points`, and distinct.
OuterShell outerShell(const std::vector<Eigen::Vector3d>& points, const std::vector<Corners>& triangles,
                      SheetOrder order);
}  // namespace gpu_planning_scene::core
