#pragma once

#include <memory>
#include <unordered_map>

#include "collision/problem/shape_key.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Finds tessellations that are still in use. Equal primitives of consecutive scenes then get the same mesh, and trees
/// are identified by their mesh.
class TessellationCache
{
 public:
  Tessellation of(const Shape& shape);

 private:
  struct Entry
  {
    std::weak_ptr<const Mesh> mesh;
    double sagitta = 0.0;
  };

  std::unordered_map<ShapeKey, Entry, ShapeKeyHash> primitives_;
  std::size_t size_when_cleared_ = 0;
};
}  // namespace gpu_planning_scene::core
