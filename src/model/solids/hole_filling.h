#pragma once

#include <vector>

#include <Eigen/Core>

#include "model/solids/orientation.h"

namespace gpu_planning_scene::core
{
/// A hole of a surface, and the triangles that fill it.
struct FilledHole
{
  std::vector<std::uint32_t> rim;  ///< in order
  std::vector<Corners> triangles;  ///< over the rim
  double area = 0.0;               ///< of the triangles, square metres
};

/// The steps that fillings of least area may still take in a mesh. Without steps left, holes are filled in a way that
/// takes little time but not the least area.
struct FillingBudget
{
  double steps = 1e8;  ///< about a second
};

/// Cuts a signed boundary into closed loops and fills each loop with triangles of least area, as long as `budget`
/// lasts. The triangles and the surface together have no signed boundary. The result depends on the points alone and
/// not on their numbers, except where two fillings have the same area.
std::vector<FilledHole> fillHoles(const std::vector<Eigen::Vector3d>& points, const std::vector<BoundaryEdge>& boundary,
                                  FillingBudget& budget);
}  // namespace gpu_planning_scene::core
