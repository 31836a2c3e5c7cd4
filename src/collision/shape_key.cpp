#include "collision/shape_key.h"

#include <tuple>

#include "collision/primitive_solid.h"

namespace gpu_planning_scene
{
/// A primitive is known by its kind and extents.
ShapeKey::ShapeKey(const Shape& shape) : kind(shape.index()), dimensions(Eigen::Vector3d::Zero()), mesh(nullptr)
{
  if (isMesh(shape))
    mesh = std::get<std::shared_ptr<const Mesh>>(shape).get();
  else
    dimensions = halfExtents(shape);
}

bool ShapeKey::operator<(const ShapeKey& other) const
{
  return std::tie(kind, dimensions.x(), dimensions.y(), dimensions.z(), mesh) <
         std::tie(other.kind, other.dimensions.x(), other.dimensions.y(), other.dimensions.z(), other.mesh);
}
}  // namespace gpu_planning_scene
