#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Makes a mesh of the polygons of a file. Equal positions become one vertex, because most formats repeat a vertex for
/// each of its triangles. Triangles without an area and repeated triangles are kept.
class MeshBuilder
{
 public:
  /// `name`: of the mesh. `scale`: per axis, the last step for each vertex.
  MeshBuilder(const std::string& name, const Eigen::Vector3d& scale);

  /// The pose of the following polygons; the identity before the first call. Under a pose and scale that mirror,
  /// triangles turn around, so that they still face outward.
  void setPose(const Eigen::Affine3d& pose);

  /// Adds a triangle or a polygon of at least 3 corners. For `hole_starts`, see triangulatePolygon. Throws Error if a
  /// placed corner is not finite or beyond kLargestLength.
  void addPolygon(const std::vector<Eigen::Vector3d>& corners, const std::vector<std::uint32_t>& hole_starts = {});

  /// The mesh. Throws Error if it has no triangles. Call it once, at the end.
  std::shared_ptr<const Mesh> finish();

 private:
  std::uint32_t place(const Eigen::Vector3d& corner);
  std::uint32_t weld(const Eigen::Vector3d& vertex);
  void add(std::array<std::uint32_t, 3> triangle);
  std::size_t slotOf(const Eigen::Vector3d& vertex) const;
  void growSlots();

  std::shared_ptr<Mesh> mesh_;
  const Eigen::Vector3d scale_;
  Eigen::Affine3d pose_;
  bool mirrors_ = false;
  std::vector<std::uint32_t> placed_;  // the corners of a polygon
  std::vector<std::uint32_t> slots_;   // hash table of vertices with open addressing, because files have millions
};
}  // namespace gpu_planning_scene::core
