#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Scales shapes about their own origins, and meshes, as MoveIt does, about the mean of their vertices. Instances of
/// one mesh that are scaled alike stay instances of one mesh.
class ShapeScaler
{
 public:
  /// Throws Error for a half-space, and where a dimension becomes infinite or 0.
  std::vector<PlacedShape> scaled(const std::vector<PlacedShape>& shapes, double factor);

 private:
  std::shared_ptr<const Mesh> scaledMesh(const std::shared_ptr<const Mesh>& mesh, double factor);

  std::map<std::pair<const Mesh*, double>, std::shared_ptr<const Mesh>> meshes_;
};
}  // namespace gpu_planning_scene::core
