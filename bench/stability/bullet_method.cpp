#include <btBulletCollisionCommon.h>

#include "stability/peers.h"

namespace gpu_planning_scene::stability
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
  std::unique_ptr<btConvexShape> operator()(const Box& box) const
  {
    return std::make_unique<btBoxShape>(toBullet(0.5 * box.size));
  }
  std::unique_ptr<btConvexShape> operator()(const Sphere& sphere) const
  {
    return std::make_unique<btSphereShape>(static_cast<btScalar>(sphere.radius));
  }
  std::unique_ptr<btConvexShape> operator()(const Cylinder& c) const
  {
    return std::make_unique<btCylinderShapeZ>(toBullet({c.radius, c.radius, 0.5 * c.length}));
  }
  std::unique_ptr<btConvexShape> operator()(const Cone& cone) const
  {
    return std::make_unique<btConeShapeZ>(static_cast<btScalar>(cone.radius), static_cast<btScalar>(cone.length));
  }
  std::unique_ptr<btConvexShape> operator()(const HalfSpace&) const { return nullptr; }
  std::unique_ptr<btConvexShape> operator()(const std::shared_ptr<const Mesh>& mesh) const
  {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Eigen::Vector3d& vertex : mesh->vertices)
      hull->addPoint(toBullet(vertex), false);
    hull->recalcLocalAabb();
    return hull;
  }
};

struct Contact : btCollisionWorld::ContactResultCallback
{
  explicit Contact(btScalar within) : required(within) { m_closestDistanceThreshold = within; }

  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override
  {
    found = found || point.getDistance() <= required;
    return 0;
  }

  btScalar required;
  bool found = false;
};
}  // namespace

bool bulletCollides(const Case& c)
{
  const auto shape_a = std::visit(MakeShape(), c.a);
  const auto shape_b = std::visit(MakeShape(), c.b);
  // A margin would round the corners. A sphere's is its radius.
  for (btConvexShape* shape : {shape_a.get(), shape_b.get()})
  {
    if (shape->getShapeType() != SPHERE_SHAPE_PROXYTYPE)
      shape->setMargin(0);
  }
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btCollisionWorld world(&dispatcher, &broadphase, &configuration);
  btCollisionObject a;
  btCollisionObject b;
  a.setCollisionShape(shape_a.get());
  b.setCollisionShape(shape_b.get());
  a.setWorldTransform(toBullet(c.link_a * c.a_in_link));
  b.setWorldTransform(toBullet(c.pose_b));
  Contact contact(static_cast<btScalar>(requiredDistance(c)));
  world.contactPairTest(&a, &b, contact);
  return contact.found;
}
}  // namespace gpu_planning_scene::stability
