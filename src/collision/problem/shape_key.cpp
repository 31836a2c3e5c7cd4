#include "collision/problem/shape_key.h"

#include <cstdint>
#include <functional>

#include "collision/geometry/primitive_solid.h"

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
  std::uint64_t hash = key.kind ^ reinterpret_cast<std::uintptr_t>(key.mesh);
  for (const double dimension : key.dimensions)
  {
    hash = (hash ^ std::hash<double>()(dimension)) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 32U;
  }
  return hash;
}
}  // namespace gpu_planning_scene::core
