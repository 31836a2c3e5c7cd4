// Bullet as motion planners commonly use it: each mesh is replaced by its convex hull, and GJK (Gilbert, Johnson and
// Keerthi 1988) tests pairs whose axis-aligned boxes overlap. A hull fills the concavities of its mesh, so this method
// reports some free states as colliding. The benchmark shows this error.

#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <btBulletCollisionCommon.h>

#include "benchmark/pairwise_peer.h"
#include "peers/bullet_shapes.h"

namespace gpu_planning_scene::core::benchmark
{
namespace
{
class BulletHulls : public PairwisePeer
{
 public:
  explicit BulletHulls(const std::shared_ptr<const CollisionProblem>& problem) : PairwisePeer(problem)
  {
    for (const Shape& shape : problem->shapes)
      shapes_.push_back(bulletShape(shape, HullPoints::Corners));
    for (const ShapeInstance& instance : problem->world)
      world_.push_back(placed(instance, instance.pose));
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
    for (const ShapeInstance& instance : problem().robot)
      robot_.push_back(placed(instance, link_poses[instance.link] * instance.pose));
  }
  bool collidesWithWorld(std::size_t robot, std::size_t world, double required) override
  {
    return meet(robot_[robot], world_[world], static_cast<btScalar>(required));
  }
  bool collidesWithSelf(std::size_t first, std::size_t second) override
  {
    return meet(robot_[first], robot_[second], 0);
  }

  Placed placed(const ShapeInstance& instance, const Eigen::Isometry3d& pose) const
  {
    Placed result{shapes_[instance.tree].get(), bulletPose(pose), {}, {}};
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
    // Slightly above `required`: Bullet does not report a pair at exactly the maximum distance.
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
}  // namespace gpu_planning_scene::core::benchmark
