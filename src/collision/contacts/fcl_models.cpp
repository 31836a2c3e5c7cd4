#include "collision/contacts/fcl_models.h"

#include <vector>

// Must precede BVH_model.h, whose templates need this header but do not include it.
#include <fcl/math/bv/utility.h>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

namespace gpu_planning_scene::core
{
namespace
{
FclGeometry makeTree(const Mesh& mesh)
{
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles)
    triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices.size()));
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}
}  // namespace

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
    geometry = makeTree(*tessellation.mesh);
  geometry->computeLocalAABB();
  return geometry;
}
}  // namespace gpu_planning_scene::core
