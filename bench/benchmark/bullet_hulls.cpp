// Bullet as robots' planners use it: each mesh replaced by its convex hull, GJK on pairs whose boxes meet. Hollows are
// filled by that, so it calls free states colliding; that is the point of showing it.

#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <LinearMath/btConvexHullComputer.h>
#include <btBulletCollisionCommon.h>

#include "benchmark/pairwise_peer.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::benchmark
{
namespace
{
btVector3 toBullet(const Eigen::Vector3d& v)
{
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

btTransform toBullet(const Eigen::Isometry3d& pose)
{
  const Eigen::Matrix<btScalar, 3, 3> r = pose.linear().cast<btScalar>();
  return btTransform(btMatrix3x3(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)),
                     toBullet(pose.translation()));
}

struct MakeShape
{
  std::shared_ptr<btConvexShape> operator()(const Box& box) const
  {
    return std::make_shared<btBoxShape>(toBullet(0.5 * box.size));
  }
  std::shared_ptr<btConvexShape> operator()(const Sphere& sphere) const
  {
    return std::make_shared<btSphereShape>(static_cast<btScalar>(sphere.radius));
  }
  std::shared_ptr<btConvexShape> operator()(const Cylinder& c) const
  {
    return std::make_shared<btCylinderShapeZ>(toBullet({c.radius, c.radius, 0.5 * c.length}));
  }
  std::shared_ptr<btConvexShape> operator()(const Cone& cone) const
  {
    return std::make_shared<btConeShapeZ>(static_cast<btScalar>(cone.radius), static_cast<btScalar>(cone.length));
  }
  std::shared_ptr<btConvexShape> operator()(const HalfSpace&) const
  {
    throw Error("the Bullet peer knows no half-spaces; compare with a scene that has none");
  }
  std::shared_ptr<btConvexShape> operator()(const std::shared_ptr<const Mesh>& mesh) const
  {
    std::vector<btVector3> points;
    for (const Eigen::Vector3d& vertex : mesh->vertices)
      points.push_back(toBullet(vertex));
    // GJK looks at every point of a hull, so only its corners are given.
    btConvexHullComputer computer;
    computer.compute(points.front().m_floats, sizeof(btVector3), static_cast<int>(points.size()), 0, 0);
    auto hull = std::make_shared<btConvexHullShape>();
    for (int i = 0; i < computer.vertices.size(); ++i)
      hull->addPoint(computer.vertices[i], false);
    hull->recalcLocalAabb();
    return hull;
  }
};

class BulletHulls : public PairwisePeer
{
 public:
  explicit BulletHulls(const std::shared_ptr<const CollisionProblem>& problem) : PairwisePeer(problem)
  {
    for (const Shape& shape : problem->shapes)
    {
      shapes_.push_back(std::visit(MakeShape(), shape));
      // A margin would round the corners. A sphere's is its radius.
      if (shapes_.back()->getShapeType() != SPHERE_SHAPE_PROXYTYPE)
        shapes_.back()->setMargin(0);
    }
    for (const Geometry& geometry : problem->world)
      world_.push_back(placed(geometry, geometry.pose));
  }

  std::unique_ptr<Peer> copy() const override { return std::make_unique<BulletHulls>(*this); }

 private:
  struct Placed
  {
    btConvexShape* shape;
    btTransform pose;
    btVector3 lower;
    btVector3 upper;
  };

  void place(const Eigen::Isometry3d* link_poses) override
  {
    robot_.clear();
    for (const Geometry& geometry : problem().robot)
      robot_.push_back(placed(geometry, link_poses[geometry.link] * geometry.pose));
  }
  bool meetsWorld(std::size_t robot, std::size_t world, double required) override
  {
    return meet(robot_[robot], world_[world], static_cast<btScalar>(required));
  }
  bool meetsSelf(std::size_t first, std::size_t second) override { return meet(robot_[first], robot_[second], 0); }

  Placed placed(const Geometry& geometry, const Eigen::Isometry3d& pose) const
  {
    Placed result{shapes_[geometry.tree].get(), toBullet(pose), {}, {}};
    result.shape->getAabb(result.pose, result.lower, result.upper);
    return result;
  }

  static bool meet(const Placed& a, const Placed& b, btScalar required)
  {
    for (int axis = 0; axis < 3; ++axis)
      if (a.lower[axis] > b.upper[axis] + required || b.lower[axis] > a.upper[axis] + required)
        return false;
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver depth;
    btGjkPairDetector detector(a.shape, b.shape, &simplex, &depth);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA = a.pose;
    input.m_transformB = b.pose;
    // A little more than is asked for: at equality it would not report.
    const btScalar limit = required + btScalar(1e-4);
    input.m_maximumDistanceSquared = limit * limit;
    btPointCollector found;
    detector.getClosestPoints(input, found, nullptr);
    return found.m_hasResult && found.m_distance <= required;
  }

  std::vector<std::shared_ptr<btConvexShape>> shapes_;
  std::vector<Placed> robot_;
  std::vector<Placed> world_;
};
}  // namespace

std::unique_ptr<PairwisePeer> makeBulletHulls(const std::shared_ptr<const CollisionProblem>& problem)
{
  return std::make_unique<BulletHulls>(problem);
}
}  // namespace gpu_planning_scene::benchmark
