#pragma once

#include <memory>
#include <vector>

// Must precede BVH_model.h, whose templates need this header but do not include it.
#include <fcl/math/bv/utility.h>

#include <fcl/geometry/bvh/BVH_model.h>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// FCL's tree over the triangles of a mesh.
template <class BoundingVolume>
std::shared_ptr<fcl::BVHModel<BoundingVolume>> makeFclTree(const Mesh& mesh)
{
  auto model = std::make_shared<fcl::BVHModel<BoundingVolume>>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles)
    triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices.size()));
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}
}  // namespace gpu_planning_scene::core
