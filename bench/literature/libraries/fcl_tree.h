#pragma once

#include <memory>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::literature
{
/// A tree of FCL over the triangles of a mesh, built as the section "Interfaces" of FCL's README shows.
template <class Volume>
std::shared_ptr<const fcl::BVHModel<Volume>> fclTree(const Mesh& mesh)
{
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles)
    triangles.emplace_back(t[0], t[1], t[2]);
  auto tree = std::make_shared<fcl::BVHModel<Volume>>();
  tree->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices.size()));
  tree->addSubModel(mesh.vertices, triangles);
  tree->endModel();
  return tree;
}
}  // namespace gpu_planning_scene::core::literature
