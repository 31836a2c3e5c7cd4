#include "support/fcl_broad_phase.h"

#include <cassert>  // FCL 0.7 uses assert without it

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

namespace gpu_planning_scene::core
{
namespace
{
/// The manager reads only an object's bounding box. The caller identifies the objects found by their numbers.
class Boxed : public fcl::CollisionObjectd
{
 public:
  Boxed(const std::shared_ptr<fcl::Sphered>& any, std::uint32_t number) : fcl::CollisionObjectd(any), number_(number) {}
  void setBounds(const Eigen::AlignedBox3d& bounds)
  {
    aabb.min_ = bounds.min();
    aabb.max_ = bounds.max();
  }
  std::uint32_t number() const { return number_; }

 private:
  std::uint32_t number_;
};

/// FCL passes the query as the second object.
bool collect(fcl::CollisionObjectd* found, fcl::CollisionObjectd* /*query*/, void* numbers)
{
  static_cast<std::vector<std::uint32_t>*>(numbers)->push_back(static_cast<const Boxed*>(found)->number());
  return false;
}
}  // namespace

struct FclBroadPhase::Impl
{
  std::shared_ptr<fcl::Sphered> any = std::make_shared<fcl::Sphered>(1.0);
  Boxed query{any, 0};
  std::vector<std::unique_ptr<Boxed>> objects;
  fcl::DynamicAABBTreeCollisionManagerd manager;
  std::vector<std::uint32_t> found;
};

FclBroadPhase::FclBroadPhase(const std::vector<Eigen::AlignedBox3d>& boxes) : impl_(std::make_unique<Impl>())
{
  std::vector<fcl::CollisionObjectd*> objects;
  for (const Eigen::AlignedBox3d& box : boxes)
  {
    impl_->objects.push_back(std::make_unique<Boxed>(impl_->any, static_cast<std::uint32_t>(impl_->objects.size())));
    impl_->objects.back()->setBounds(box);
    objects.push_back(impl_->objects.back().get());
  }
  impl_->manager.registerObjects(objects);
  impl_->manager.setup();
}

FclBroadPhase::~FclBroadPhase() = default;

const std::vector<std::uint32_t>& FclBroadPhase::near(const Eigen::AlignedBox3d& bounds)
{
  impl_->found.clear();
  impl_->query.setBounds(bounds);
  impl_->manager.collide(&impl_->query, &impl_->found, collect);
  return impl_->found;
}
}  // namespace gpu_planning_scene::core
