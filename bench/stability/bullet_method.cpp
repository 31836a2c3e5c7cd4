#include <btBulletCollisionCommon.h>

#include "peers/bullet_shapes.h"
#include "stability/peers.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
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
  const auto shape_a = bulletShape(c.a, HullPoints::AllVertices);
  const auto shape_b = bulletShape(c.b, HullPoints::AllVertices);
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btCollisionWorld world(&dispatcher, &broadphase, &configuration);
  btCollisionObject a;
  btCollisionObject b;
  a.setCollisionShape(shape_a.get());
  b.setCollisionShape(shape_b.get());
  a.setWorldTransform(bulletPose(c.link_a * c.a_in_link));
  b.setWorldTransform(bulletPose(c.pose_b));
  Contact contact(static_cast<btScalar>(requiredDistance(c)));
  world.contactPairTest(&a, &b, contact);
  return contact.found;
}
}  // namespace gpu_planning_scene::core::stability
