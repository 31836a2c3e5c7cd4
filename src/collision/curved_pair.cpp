#include "collision/curved_pair.h"

#include <memory>

#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

namespace gpu_planning_scene
{
namespace
{
constexpr double kFclAccuracy = 1e-6;  // metres

std::shared_ptr<fcl::CollisionGeometryd> fclShape(const Shape& shape)
{
  if (const auto* cone = std::get_if<Cone>(&shape))
  {
    return std::make_shared<fcl::Coned>(cone->radius, cone->length);
  }
  const auto& cylinder = std::get<Cylinder>(shape);
  return std::make_shared<fcl::Cylinderd>(cylinder.radius, cylinder.length);
}
}  // namespace

bool curvedSolidsMeet(const Shape& a, const Shape& b, const Eigen::Isometry3d& b_in_a)
{
  const fcl::CollisionObjectd object_a(fclShape(a), Eigen::Isometry3d::Identity());
  const fcl::CollisionObjectd object_b(fclShape(b), b_in_a);
  fcl::CollisionResultd contact;
  if (fcl::collide(&object_a, &object_b, fcl::CollisionRequestd(1, true), contact) > 0)
  {
    return true;
  }
  fcl::DistanceRequestd request;
  request.distance_tolerance = kFclAccuracy;
  fcl::DistanceResultd result;
  return fcl::distance(&object_a, &object_b, request, result) <= kFclAccuracy;
}
}  // namespace gpu_planning_scene
