#include "support/fcl_peer.h"

#include <algorithm>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "gpu_planning_scene/error.h"
#include "support/inside.h"

namespace gpu_planning_scene
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using FclGeometry = std::shared_ptr<fcl::CollisionGeometryd>;

constexpr double kNudge = 1e-6;  // metres

FclGeometry makeBvh(const Mesh& mesh)
{
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles)
  {
    triangles.emplace_back(t[0], t[1], t[2]);
  }
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices.size()));
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

FclGeometry makeGeometry(const Shape& shape, const Tessellation& tessellation)
{
  FclGeometry geometry;
  if (const auto* sphere = std::get_if<Sphere>(&shape))
  {
    geometry = std::make_shared<fcl::Sphered>(sphere->radius);
  }
  else if (const auto* cylinder = std::get_if<Cylinder>(&shape))
  {
    geometry = std::make_shared<fcl::Cylinderd>(cylinder->radius, cylinder->length);
  }
  else if (const auto* cone = std::get_if<Cone>(&shape))
  {
    geometry = std::make_shared<fcl::Coned>(cone->radius, cone->length);
  }
  else
  {
    geometry = makeBvh(*tessellation.mesh);
  }
  geometry->computeLocalAABB();
  return geometry;
}

/// Better no comparison than one with another problem.
void refuseUnsupported(const CollisionProblem& problem)
{
  const auto is_padded = [](const Geometry& geometry) { return geometry.padding > 0.0; };
  if (!problem.half_spaces.empty() || std::any_of(problem.robot.begin(), problem.robot.end(), is_padded) ||
      std::any_of(problem.world.begin(), problem.world.end(), is_padded))
  {
    throw Error("the FCL peer knows neither half-spaces nor padding; compare with a scene that has none");
  }
}
}  // namespace

struct FclPeer::Impl
{
  /// An instance of a geometry with its place in the planning frame.
  struct Placed
  {
    std::int32_t body;
    std::uint32_t tree;
    Isometry3d pose;
    AlignedBox3d bounds;
  };

  std::shared_ptr<const CollisionProblem> problem;
  std::vector<FclGeometry> geometries;  // one per tree
  std::vector<Placed> robot;
  std::vector<Placed> world;

  AlignedBox3d boundsOf(std::uint32_t tree, const Isometry3d& pose) const
  {
    const auto& local = geometries[tree]->aabb_local;
    const Vector3d center = pose * local.center();
    const Vector3d half = pose.linear().cwiseAbs() * (0.5 * (local.max_ - local.min_));
    return {center - half, center + half};
  }

  bool hit(const Placed& a, const Placed& b, const Vector3d& shift_of_b = Vector3d::Zero()) const
  {
    Isometry3d pose_b = b.pose;
    pose_b.pretranslate(shift_of_b);
    const fcl::CollisionRequestd request(1, true);
    fcl::CollisionResultd result;
    return fcl::collide(geometries[a.tree].get(), a.pose, geometries[b.tree].get(), pose_b, request, result) > 0;
  }

  double distance(const Placed& a, const Placed& b) const
  {
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    return fcl::distance(geometries[a.tree].get(), a.pose, geometries[b.tree].get(), b.pose, request, result);
  }

  /// Calls visit(a, b) for the checked pairs of geometries until it returns true.
  template <class Visit>
  void visitPairs(const Visit& visit) const
  {
    for (std::size_t i = 0; i < robot.size(); ++i)
    {
      for (std::size_t k = 0; k < world.size(); ++k)
      {
        if (problem->world_pairs[i * world.size() + k] != 0 && visit(robot[i], world[k]))
        {
          return;
        }
      }
    }
    for (const auto& [first, second] : problem->self_pairs)
    {
      if (visit(robot[first], robot[second]))
      {
        return;
      }
    }
  }

  /// Calls visit(a, b) for the checked pairs of geometries of two bodies.
  template <class Visit>
  void visitPairsOf(const BodyPair& pair, const Visit& visit) const
  {
    visitPairs(
        [&](const Placed& a, const Placed& b)
        {
          if (BodyPair{a.body, b.body} == pair || BodyPair{b.body, a.body} == pair)
          {
            visit(a, b);
          }
          return false;
        });
  }
};

FclPeer::FclPeer(std::shared_ptr<const CollisionProblem> problem) : impl_(std::make_unique<Impl>())
{
  refuseUnsupported(*problem);
  impl_->problem = std::move(problem);
  const CollisionProblem& p = *impl_->problem;
  for (std::size_t i = 0; i < p.trees.size(); ++i)
  {
    impl_->geometries.push_back(makeGeometry(p.shapes[i], p.trees[i]));
  }
  for (const Geometry& geometry : p.robot)
  {
    impl_->robot.push_back({geometry.body, geometry.tree, geometry.pose, {}});
  }
  for (const Geometry& geometry : p.world)
  {
    impl_->world.push_back(
        {geometry.body, geometry.tree, geometry.pose, impl_->boundsOf(geometry.tree, geometry.pose)});
  }
}

FclPeer::~FclPeer() = default;

void FclPeer::setState(const Isometry3d* link_poses)
{
  for (std::size_t i = 0; i < impl_->robot.size(); ++i)
  {
    Impl::Placed& placed = impl_->robot[i];
    const Geometry& geometry = impl_->problem->robot[i];
    placed.pose = link_poses[geometry.link] * geometry.pose;
    placed.bounds = impl_->boundsOf(placed.tree, placed.pose);
  }
}

std::optional<FclPeer::BodyPair> FclPeer::firstCollision() const
{
  std::optional<BodyPair> found;
  impl_->visitPairs(
      [&](const Impl::Placed& a, const Impl::Placed& b)
      {
        if (a.bounds.intersects(b.bounds) && impl_->hit(a, b))
        {
          found = BodyPair{a.body, b.body};
        }
        return found.has_value();
      });
  return found;
}

std::vector<FclPeer::BodyPair> FclPeer::allCollisions() const
{
  std::vector<BodyPair> found;
  impl_->visitPairs(
      [&](const Impl::Placed& a, const Impl::Placed& b)
      {
        if (a.bounds.intersects(b.bounds) && impl_->hit(a, b))
        {
          found.push_back({a.body, b.body});
        }
        return false;
      });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

bool FclPeer::collides(const BodyPair& pair) const
{
  bool hit = false;
  impl_->visitPairsOf(pair, [&](const Impl::Placed& a, const Impl::Placed& b) { hit = hit || impl_->hit(a, b); });
  return hit;
}

bool FclPeer::freeWhenMovedApart(const BodyPair& pair) const
{
  Vector3d between = Vector3d::UnitX();
  impl_->visitPairsOf(pair, [&](const Impl::Placed& a, const Impl::Placed& b)
                      { between = (b.bounds.center() - a.bounds.center()).normalized(); });
  const std::array<Vector3d, 7> directions = {between,           Vector3d::UnitX(),  -Vector3d::UnitX(),
                                              Vector3d::UnitY(), -Vector3d::UnitY(), Vector3d::UnitZ(),
                                              -Vector3d::UnitZ()};
  return std::any_of(directions.begin(), directions.end(),
                     [&](const Vector3d& direction)
                     {
                       bool hit = false;
                       impl_->visitPairsOf(pair, [&](const Impl::Placed& a, const Impl::Placed& b)
                                           { hit = hit || impl_->hit(a, b, kNudge * direction); });
                       return !hit;
                     });
}

bool FclPeer::within(const BodyPair& pair, double distance) const
{
  bool found = false;
  impl_->visitPairsOf(
      pair, [&](const Impl::Placed& a, const Impl::Placed& b) { found = found || impl_->distance(a, b) <= distance; });
  return found;
}

bool FclPeer::oneInsideTheOther(const BodyPair& pair) const
{
  bool found = false;
  impl_->visitPairsOf(pair,
                      [&](const Impl::Placed& a, const Impl::Placed& b)
                      {
                        const auto& shapes = impl_->problem->shapes;
                        const auto& trees = impl_->problem->trees;
                        const Isometry3d b_in_a = a.pose.inverse() * b.pose;
                        found = found || hasVertexInside(*trees[b.tree].mesh, b_in_a, shapes[a.tree]) ||
                                hasVertexInside(*trees[a.tree].mesh, b_in_a.inverse(), shapes[b.tree]);
                      });
  return found;
}
}  // namespace gpu_planning_scene
