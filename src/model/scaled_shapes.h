#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Scales shapes about their own origins, and meshes about the mean of their vertices, as MoveIt does. Instances of a
/// mesh that have the same factor share one scaled mesh. Not thread-safe.
class ShapeScaler
{
 public:
  /// Throws Error for a half-space, and if a scaled dimension is not valid (validateShape).
  std::vector<PlacedShape> scaled(const std::vector<PlacedShape>& shapes, double factor);

 private:
  std::shared_ptr<const Mesh> scaledMesh(const std::shared_ptr<const Mesh>& mesh, double factor);

  std::map<std::pair<const Mesh*, double>, std::shared_ptr<const Mesh>> meshes_;
};

/// Whether `scaled` is what ShapeScaler makes of the shapes, so that it is not that of an earlier factor or of other
/// shapes. Throws the errors of ShapeScaler::scaled.
bool isScaled(const std::vector<PlacedShape>& scaled, const std::vector<PlacedShape>& shapes, double factor);
}  // namespace gpu_planning_scene::core
