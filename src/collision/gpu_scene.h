#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "collision/collision_problem.h"
#include "collision/gpu_forest.h"
#include "gpu/buffer.h"

namespace gpu_planning_scene
{
/// A collision problem in GPU memory: the trees of all distinct shapes, the instances, the tree over world instances
/// and the pairs that are checked. Used on the context's thread.
class GpuScene
{
 public:
  explicit GpuScene(const std::string& shader_folder) : builder_(shader_folder) {}

  /// Uploads a problem and builds its trees; those of the robot stay if they are the ones that are there. Throws Error
  /// if the problem is too large for the device; the scene is then unusable until the next setProblem.
  void setProblem(const CollisionProblem& problem);

  /// Restricts the checked pairs to those of `problem`, which has the same trees and instances as the one uploaded.
  void selectPairs(const CollisionProblem& problem);

  /// Binds what all kernels read: nodes, triangles, world poses, instances.
  void bind() const;
  const Buffer& partners() const { return partners_; }
  const Buffer& worldOrder() const { return world_order_; }
  const Buffer& worldPairs() const { return world_pairs_; }
  const Buffer& components() const { return components_; }
  const Buffer& leafOrder() const { return leaf_order_; }
  const Buffer& solidTriangles() const { return solid_triangles_; }
  const Buffer& halfSpaces() const { return half_spaces_; }
  const Buffer& halfSpacePairs() const { return half_space_pairs_; }

  std::uint32_t robotCount() const { return robot_count_; }
  std::uint32_t worldCount() const { return world_count_; }
  std::uint32_t worldRoot() const { return world_root_; }
  std::uint32_t halfSpaceCount() const { return half_space_count_; }
  bool hasSelfPairs() const { return has_self_pairs_; }
  /// Whether some pairs have a required distance.
  bool isPadded() const { return padded_; }
  /// Whether a mesh has closed components.
  bool hasMeshSolids() const { return has_mesh_solids_; }
  /// In the leaf order, where the shapes begin that the robot does not have.
  std::uint32_t firstWorldPrimitive() const { return shape_region_.first_primitive; }

  /// No tree has more levels than this.
  std::uint32_t depthBound() const { return depth_bound_; }

  /// The trees as the CPU can walk them; reads back from the GPU.
  Forest readForest() const;

 private:
  void buildShapeTrees(const CollisionProblem& problem);
  void buildWorldTree(const CollisionProblem& problem);

  /// Where a tree's components lie among all.
  struct ComponentRange
  {
    std::uint32_t first;
    std::uint32_t count;  // 0: too many
    bool mesh_solid;      // it is a mesh, and some are closed
  };
  using ComponentRanges = std::vector<ComponentRange>;
  ComponentRanges writeComponents(const CollisionProblem& problem);
  void writeGeometries(const CollisionProblem& problem);
  void writeHalfSpaces(const CollisionProblem& problem);
  std::uint32_t rootOf(std::size_t tree) const;

  GpuForestBuilder builder_;
  TexelBuffer nodes_, triangles_, world_poses_;
  Buffer leaf_order_, geometries_, components_, solid_triangles_, partners_, world_order_, world_pairs_;
  Buffer half_spaces_, half_space_pairs_;
  ForestRegion robot_region_, shape_region_;
  std::vector<Shape> robot_shapes_;  // whose trees are in robot_region_
  std::size_t trees_ = 0;
  std::vector<std::uint32_t> first_triangle_;  // of each tree, among all
  std::uint32_t triangle_count_ = 0;
  std::uint32_t robot_count_ = 0;
  std::uint32_t world_count_ = 0;
  std::uint32_t world_root_ = 0;
  std::uint32_t depth_bound_ = 0;
  std::uint32_t half_space_count_ = 0;
  bool has_self_pairs_ = false;
  bool padded_ = false;
  bool has_mesh_solids_ = false;
};

/// The rows of [rotation | translation] as a shader reads them (shaders/pose.glsl).
void writePoseRows(const Eigen::Isometry3d& pose, float* rows);
}  // namespace gpu_planning_scene
