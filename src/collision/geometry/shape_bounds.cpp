#include "collision/geometry/shape_bounds.h"

#include "collision/geometry/primitive_solid.h"

namespace gpu_planning_scene::core
{
Eigen::AlignedBox3d boundsOf(const Shape& shape)
{
  if (!isMesh(shape))
    return {-halfExtents(shape), halfExtents(shape)};
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : std::get<std::shared_ptr<const Mesh>>(shape)->vertices)
    box.extend(vertex);
  return box;
}
}  // namespace gpu_planning_scene::core
