#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "model/solids/mesh_edges.h"

namespace gpu_planning_scene::core
{
using Numbers = std::vector<std::uint32_t>;

enum class WeldedCorners
{
  All,
  OfFreeEdges  ///< of edges that an odd number of triangles use
};

/// Triangles are in one part if a chain of these connects them.
enum class ConnectedBy
{
  CommonEdges,
  CommonCorners  ///< missing triangles may cut a surface into pieces that have only corners in common
};

/// The triangles of a mesh with corners that were welded: places near each other count as one. Triangles are known by
/// their numbers.
class WeldedTriangles
{
 public:
  /// Welds places within `tolerance` (metres) of each other. `points` must outlive this object.
  WeldedTriangles(const std::vector<Eigen::Vector3d>& points, const std::vector<Corners>& triangles, double tolerance,
                  WeldedCorners welded);

  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  /// The welded corners.
  const Corners& operator[](std::uint32_t triangle) const { return welded_[triangle]; }
  /// The place that a place was welded to.
  std::uint32_t representative(std::uint32_t place) const { return representative_[place]; }

  /// The first of each set of triangles with the same corners.
  const Numbers& distinct() const { return distinct_; }
  /// All triangles with the same corners as a distinct one, in their order.
  Numbers copies(std::uint32_t distinct) const;
  bool hasCopies(std::uint32_t distinct) const { return next_copy_[distinct] != distinct; }
  /// Triangles that have distinct corners no more.
  const Numbers& collapsed() const { return collapsed_; }

  /// Adds a triangle. Returns its number.
  std::uint32_t add(const Corners& triangle);

  std::vector<Corners> cornersOf(const Numbers& triangles) const;
  double areaOf(const Numbers& triangles) const;  ///< square metres
  std::vector<Numbers> partsOf(const Numbers& triangles, ConnectedBy connected) const;

 private:
  void findCopies(const std::vector<Corners>& triangles);

  const std::vector<Eigen::Vector3d>& points_;
  Numbers representative_;  // of each place
  std::vector<Corners> welded_;
  Numbers distinct_;
  Numbers next_copy_;  // of each triangle: the next one with the same corners; itself: there is none
  Numbers collapsed_;
};
}  // namespace gpu_planning_scene::core
