#include "support/fcl_trees.h"

#include <map>
#include <mutex>
#include <vector>

#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

#include "support/fcl_tree.h"

namespace gpu_planning_scene::core
{
namespace
{
/// FCL's primitive for a sphere, cylinder or cone; null for any other shape.
FclGeometry makeFclRound(const Shape& shape)
{
  FclGeometry geometry;
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    geometry = std::make_shared<fcl::Sphered>(sphere->radius);
  else if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    geometry = std::make_shared<fcl::Cylinderd>(cylinder->radius, cylinder->length);
  else if (const auto* cone = std::get_if<Cone>(&shape))
    geometry = std::make_shared<fcl::Coned>(cone->radius, cone->length);
  else
    return nullptr;
  geometry->computeLocalAABB();
  return geometry;
}

FclGeometry makeTree(const Mesh& mesh, FclTree tree)
{
  switch (tree)
  {
    case FclTree::Obb:
      return makeFclTree<fcl::OBBd>(mesh);
    case FclTree::Aabb:
      return makeFclTree<fcl::AABBd>(mesh);
    case FclTree::Kios:
      return makeFclTree<fcl::kIOSd>(mesh);
    case FclTree::Kdop24:
      return makeFclTree<fcl::KDOP<double, 24>>(mesh);
    default:
      return makeFclTree<fcl::OBBRSSd>(mesh);
  }
}

template <class BoundingVolume>
class MovedTree : public FclMovedTree
{
 public:
  explicit MovedTree(std::shared_ptr<const Mesh> mesh)
    : mesh_(std::move(mesh)), model_(makeFclTree<BoundingVolume>(*mesh_)), vertices_(mesh_->vertices)
  {
  }

  const fcl::CollisionGeometryd* at(const Eigen::Isometry3d& pose) override
  {
    if (pose.matrix() == pose_.matrix())
      return model_.get();
    pose_ = pose;
    for (std::size_t i = 0; i < vertices_.size(); ++i)
      vertices_[i] = pose * mesh_->vertices[i];
    model_->beginReplaceModel();
    model_->replaceSubModel(vertices_);
    model_->endReplaceModel(true, true);
    return model_.get();
  }

 private:
  std::shared_ptr<const Mesh> mesh_;
  std::shared_ptr<fcl::BVHModel<BoundingVolume>> model_;
  std::vector<Eigen::Vector3d> vertices_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
};

/// The tree over a mesh. Queries do not change trees of oriented boxes, so peers share one as long as any of them uses
/// it: FCL needs a second for the meshes of a real robot.
FclGeometry treeOf(const std::shared_ptr<const Mesh>& mesh, FclTree tree)
{
  struct Known
  {
    std::weak_ptr<const Mesh> mesh;
    std::weak_ptr<fcl::CollisionGeometry<double>> tree;
  };
  static std::mutex mutex;
  static std::map<const Mesh*, Known> all_known;
  const std::lock_guard<std::mutex> lock(mutex);
  Known& known = all_known[mesh.get()];
  FclGeometry model = tree == FclTree::Obbrss && known.mesh.lock() == mesh ? known.tree.lock() : nullptr;
  if (model)
    return model;
  model = makeTree(*mesh, tree);
  model->computeLocalAABB();
  if (tree == FclTree::Obbrss)
    known = {mesh, model};
  return model;
}
}  // namespace

FclGeometry makeFclGeometry(const Shape& shape, const Tessellation& tessellation, FclTree tree)
{
  if (FclGeometry round = makeFclRound(shape))
    return round;
  return treeOf(tessellation.mesh, tree);
}

std::shared_ptr<FclMovedTree> makeFclMovedTree(const Shape& shape, const Tessellation& tessellation, FclTree tree)
{
  if (std::holds_alternative<Sphere>(shape) || std::holds_alternative<Cylinder>(shape) ||
      std::holds_alternative<Cone>(shape))
    return nullptr;
  if (tree == FclTree::Aabb)
    return std::make_shared<MovedTree<fcl::AABBd>>(tessellation.mesh);
  if (tree == FclTree::Kdop24)
    return std::make_shared<MovedTree<fcl::KDOP<double, 24>>>(tessellation.mesh);
  return nullptr;
}
}  // namespace gpu_planning_scene::core
