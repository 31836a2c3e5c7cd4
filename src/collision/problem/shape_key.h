#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Keys are equal if the shapes can share a tree: primitives of the same kind and dimensions, or the same mesh.
struct ShapeKey
{
  /// `shape` must not be a half-space.
  explicit ShapeKey(const Shape& shape);

  std::size_t kind;
  Eigen::Vector3d dimensions;
  const Mesh* mesh;

  bool operator==(const ShapeKey& other) const
  {
    return kind == other.kind && mesh == other.mesh && dimensions == other.dimensions;
  }
};

struct ShapeKeyHash
{
  std::size_t operator()(const ShapeKey& key) const;
};
}  // namespace gpu_planning_scene::core
