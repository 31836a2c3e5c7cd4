#include "peers/bullet_shapes.h"

#include <vector>

#include <LinearMath/btConvexHullComputer.h>
#include <btBulletCollisionCommon.h>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
btVector3 toBullet(const Eigen::Vector3d& v)
{
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

struct MakeShape
{
  HullPoints points;

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
    throw Error("the Bullet peer does not support half-spaces; use a scene without half-spaces");
  }
  std::shared_ptr<btConvexShape> operator()(const std::shared_ptr<const Mesh>& mesh) const
  {
    std::vector<btVector3> vertices;
    for (const Eigen::Vector3d& vertex : mesh->vertices)
      vertices.push_back(toBullet(vertex));
    auto hull = std::make_shared<btConvexHullShape>();
    if (points == HullPoints::Corners)
    {
      btConvexHullComputer computer;
      computer.compute(vertices.front().m_floats, sizeof(btVector3), static_cast<int>(vertices.size()), 0, 0);
      vertices.clear();
      for (int i = 0; i < computer.vertices.size(); ++i)
        vertices.push_back(computer.vertices[i]);
    }
    for (const btVector3& vertex : vertices)
      hull->addPoint(vertex, false);
    hull->recalcLocalAabb();
    return hull;
  }
};
}  // namespace

std::shared_ptr<btConvexShape> bulletShape(const Shape& shape, HullPoints points)
{
  std::shared_ptr<btConvexShape> made = std::visit(MakeShape{points}, shape);
  // A sphere's margin is its radius.
  if (made->getShapeType() != SPHERE_SHAPE_PROXYTYPE)
    made->setMargin(0);
  return made;
}

btTransform bulletPose(const Eigen::Isometry3d& pose)
{
  const Eigen::Matrix<btScalar, 3, 3> r = pose.linear().cast<btScalar>();
  return btTransform(btMatrix3x3(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)),
                     toBullet(pose.translation()));
}
}  // namespace gpu_planning_scene::core
