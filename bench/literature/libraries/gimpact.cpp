#include "literature/libraries/gimpact.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <btBulletCollisionCommon.h>

#include "peers/bullet_shapes.h"

// F. Leon's GImpact (2006), quantised trees of axis-aligned boxes in float, as part of Bullet. Domain: any mesh,
// surfaces only. The use is that of the comments of btGImpactShape.h (updateBound after the creation) and of
// btGImpactCollisionAlgorithm.h (registerAlgorithm on the dispatcher). The dispatcher is asked for its algorithm,
// because btCollisionWorld::contactPairTest never reports a contact of two btGImpactMeshShape. The margin is 0, because
// a margin would make the meshes thicker.
namespace gpu_planning_scene::core::literature
{
namespace
{
/// A mesh as a shape of Bullet. It owns the arrays, which Bullet only refers to.
class GimpactMesh
{
 public:
  explicit GimpactMesh(const Mesh& mesh)
  {
    for (const Eigen::Vector3d& vertex : mesh.vertices)
      for (int axis = 0; axis < 3; ++axis)
        coordinates_.push_back(static_cast<btScalar>(vertex[axis]));
    for (const auto& t : mesh.triangles)
      for (const std::uint32_t corner : t)
        indices_.push_back(static_cast<int>(corner));
    arrays_ = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(mesh.triangles.size()), indices_.data(), static_cast<int>(3 * sizeof(int)),
        static_cast<int>(mesh.vertices.size()), coordinates_.data(), static_cast<int>(3 * sizeof(btScalar)));
    shape_ = std::make_unique<btGImpactMeshShape>(arrays_.get());
    shape_->setMargin(0);
    shape_->updateBound();
    object_.setCollisionShape(shape_.get());
  }
  btCollisionObject& object() { return object_; }
  btCollisionObjectWrapper wrapped() const
  {
    return {nullptr, shape_.get(), &object_, object_.getWorldTransform(), -1, -1};
  }

 private:
  std::vector<btScalar> coordinates_;
  std::vector<int> indices_;
  std::unique_ptr<btTriangleIndexVertexArray> arrays_;
  std::unique_ptr<btGImpactMeshShape> shape_;
  btCollisionObject object_;
};

/// Notes whether there is any contact.
struct AnyContact : btManifoldResult
{
  using btManifoldResult::btManifoldResult;
  void addContactPoint(const btVector3&, const btVector3&, btScalar) override { found = true; }
  bool found = false;
};

class Gimpact : public PosewiseMethod
{
 public:
  Gimpact(const Mesh& a, const Mesh& b) : dispatcher_(&configuration_), a_(a), b_(b)
  {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
  }

 private:
  bool collides(const Eigen::Isometry3d& b_in_a) override
  {
    b_.object().setWorldTransform(bulletPose(b_in_a));
    const btCollisionObjectWrapper a = a_.wrapped();
    const btCollisionObjectWrapper b = b_.wrapped();
    btCollisionAlgorithm* algorithm = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    AnyContact result(&a, &b);
    algorithm->processCollision(&a, &b, btDispatcherInfo(), &result);
    algorithm->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm);
    return result.found;
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  GimpactMesh a_;
  GimpactMesh b_;
};
}  // namespace

std::vector<MethodInfo> gimpactMethods()
{
  return {{"gimpact",
           "GImpact (Bullet)",
           "Leon 2006; Bullet",
           "library",
           {},
           [](const auto& a, const auto& b) { return std::make_unique<Gimpact>(*a, *b); }}};
}
}  // namespace gpu_planning_scene::core::literature
