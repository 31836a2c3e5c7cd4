#include "literature/libraries/fcl_methods.h"

#include <cassert>  // FCL 0.7 uses assert without it

#include <fcl/config.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>

#include "literature/libraries/fcl_tree.h"
#include "literature/shared_tree.h"

// FCL (Pan, Chitta, Manocha, "FCL: A General Purpose Library for Collision and Proximity Queries", 2012), whose OBB
// tree is that of RAPID. Domain: any mesh; only surfaces are compared, so containment is not found. The use is that of
// the section "Interfaces" of FCL's README: a BVHModel for each mesh, one call of collide for each pose, and a default
// CollisionRequest, which stops at the first contact and computes no contact data
// (fcl/narrowphase/collision_request.h).
namespace gpu_planning_scene::core::literature
{
namespace
{
using Result = fcl::CollisionResult<double>;

template <class Volume>
bool fclCollides(const fcl::BVHModel<Volume>& a, const fcl::BVHModel<Volume>& b, const Eigen::Isometry3d& pose)
{
  Result result;
  return fcl::collide(&a, Eigen::Isometry3d(Eigen::Isometry3d::Identity()), &b, pose, fcl::CollisionRequest<double>(),
                      result) > 0;
}

template <>
bool fclCollides(const fcl::BVHModel<fcl::RSS<double>>& a, const fcl::BVHModel<fcl::RSS<double>>& b,
                 const Eigen::Isometry3d& pose)
{
  Result result;
  fcl::detail::MeshCollisionTraversalNodeRSS<double> node;
  if (!fcl::detail::initialize(node, a, Eigen::Isometry3d(Eigen::Isometry3d::Identity()), b, pose,
                               fcl::CollisionRequest<double>(), result))
    throw std::logic_error("FCL refuses a tree of RSS");
  fcl::detail::collide(&node);
  return result.numContacts() > 0;
}

template <class Volume>
struct Tree
{
  explicit Tree(const Mesh& mesh) : model(fclTree<Volume>(mesh)) {}
  std::shared_ptr<const fcl::BVHModel<Volume>> model;
};

template <class Volume>
class Fcl : public PosewiseMethod
{
 public:
  Fcl(const MeshPtr& a, const MeshPtr& b) : a_(sharedTree<Tree<Volume>>(a)), b_(sharedTree<Tree<Volume>>(b)) {}

 private:
  bool collides(const Eigen::Isometry3d& b_in_a) override { return fclCollides(*a_->model, *b_->model, b_in_a); }

  std::shared_ptr<const Tree<Volume>> a_;
  std::shared_ptr<const Tree<Volume>> b_;
};

template <class Volume>
MethodInfo info(const char* name, const char* title)
{
  return {name,      title, "FCL " FCL_VERSION,
          "library", {},    [](const auto& a, const auto& b) { return std::make_unique<Fcl<Volume>>(a, b); }};
}
}  // namespace

std::vector<MethodInfo> fclMethods()
{
  return {info<fcl::OBB<double>>("fcl_obb", "FCL, OBB"), info<fcl::RSS<double>>("fcl_rss", "FCL, RSS"),
          info<fcl::OBBRSS<double>>("fcl_obbrss", "FCL, OBBRSS"), info<fcl::kIOS<double>>("fcl_kios", "FCL, kIOS")};
}
}  // namespace gpu_planning_scene::core::literature
