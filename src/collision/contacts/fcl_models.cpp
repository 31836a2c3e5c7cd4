#include "collision/contacts/fcl_models.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

#include "collision/contacts/fcl_tree.h"

namespace gpu_planning_scene::core
{
FclGeometry makeFclRound(const Shape& shape)
{
  FclGeometry geometry;
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    geometry = std::make_shared<fcl::Sphered>(sphere->radius);
  else if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    geometry = std::make_shared<fcl::Cylinderd>(cylinder->radius, cylinder->length);
  else if (const auto* cone = std::get_if<Cone>(&shape))
    geometry = std::make_shared<fcl::Coned>(cone->radius, cone->length);
  else
    return nullptr;
  geometry->computeLocalAABB();
  return geometry;
}

FclGeometry makeFclSolid(const Shape& shape, const Tessellation& tessellation)
{
  FclGeometry geometry = makeFclRound(shape);
  if (geometry)
    return geometry;
  if (const auto* box = std::get_if<Box>(&shape))
    geometry = std::make_shared<fcl::Boxd>(box->size);
  else
    geometry = makeFclTree<fcl::OBBRSSd>(*tessellation.mesh);
  geometry->computeLocalAABB();
  return geometry;
}
}  // namespace gpu_planning_scene::core
