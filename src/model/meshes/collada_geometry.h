#pragma once

#include <map>
#include <vector>

#include <Eigen/Core>

#include "model/meshes/collada_document.h"
#include "model/meshes/mesh_builder.h"

namespace gpu_planning_scene::core
{
/// The geometries of a COLLADA file.
class ColladaGeometries
{
 public:
  explicit ColladaGeometries(const ColladaDocument& document) : document_(document) {}

  /// Adds the polygons of a <geometry>. Throws Error.
  void add(const tinyxml2::XMLElement& geometry, MeshBuilder& mesh);

 private:
  void addPrimitive(const tinyxml2::XMLElement& element, MeshBuilder& mesh);
  const std::vector<Eigen::Vector3d>& vertices(const tinyxml2::XMLElement& primitive);

  const ColladaDocument& document_;
  /// The points of each <source> that was read: the primitives of a mesh share them, as do the instances of a geometry.
  std::map<const tinyxml2::XMLElement*, std::vector<Eigen::Vector3d>> points_;
};
}  // namespace gpu_planning_scene::core
