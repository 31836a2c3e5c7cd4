#include <cassert>  // FCL 0.7 uses assert without it

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "stability/peers.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
using FclGeometry = std::shared_ptr<fcl::CollisionGeometryd>;

struct MakeGeometry
{
  FclGeometry operator()(const Box& box) const { return std::make_shared<fcl::Boxd>(box.size); }
  FclGeometry operator()(const Sphere& sphere) const { return std::make_shared<fcl::Sphered>(sphere.radius); }
  FclGeometry operator()(const Cylinder& c) const { return std::make_shared<fcl::Cylinderd>(c.radius, c.length); }
  FclGeometry operator()(const Cone& cone) const { return std::make_shared<fcl::Coned>(cone.radius, cone.length); }
  FclGeometry operator()(const HalfSpace& h) const { return std::make_shared<fcl::Halfspaced>(h.normal, h.offset); }
  FclGeometry operator()(const std::shared_ptr<const Mesh>& mesh) const
  {
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    std::vector<fcl::Triangle> triangles;
    for (const auto& t : mesh->triangles)
      triangles.emplace_back(t[0], t[1], t[2]);
    model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh->vertices.size()));
    model->addSubModel(mesh->vertices, triangles);
    model->endModel();
    return model;
  }
};
}  // namespace

std::optional<bool> fclCollides(const Case& c, bool own_narrow_phase)
{
  const double required = requiredDistance(c);
  if (required > 0.0 && std::holds_alternative<HalfSpace>(c.b))
    return std::nullopt;
  const FclGeometry a = std::visit(MakeGeometry(), c.a);
  const FclGeometry b = std::visit(MakeGeometry(), c.b);
  const Eigen::Isometry3d pose_a = c.link_a * c.a_in_link;
  const fcl::GJKSolverType solver = own_narrow_phase ? fcl::GST_INDEP : fcl::GST_LIBCCD;
  if (required > 0.0)
  {
    fcl::DistanceRequestd request;
    request.gjk_solver_type = solver;
    fcl::DistanceResultd result;
    return fcl::distance(a.get(), pose_a, b.get(), c.pose_b, request, result) <= required;
  }
  fcl::CollisionRequestd request(1, false);
  request.gjk_solver_type = solver;
  fcl::CollisionResultd result;
  return fcl::collide(a.get(), pose_a, b.get(), c.pose_b, request, result) > 0;
}
}  // namespace gpu_planning_scene::core::stability
