#include "collision/problem/shape_key.h"

#include <cstdint>

#include "collision/geometry/primitive_solid.h"
#include "model/coordinate_hash.h"

namespace gpu_planning_scene::core
{
/// The kind and the half extents identify a primitive.
ShapeKey::ShapeKey(const Shape& shape) : kind(shape.index()), dimensions(Eigen::Vector3d::Zero()), mesh(nullptr)
{
  if (isMesh(shape))
    mesh = std::get<std::shared_ptr<const Mesh>>(shape).get();
  else
    dimensions = halfExtents(shape);
}

std::size_t ShapeKeyHash::operator()(const ShapeKey& key) const
{
  return hashOf(key.dimensions, key.kind ^ reinterpret_cast<std::uintptr_t>(key.mesh));
}
}  // namespace gpu_planning_scene::core
