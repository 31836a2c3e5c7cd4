#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "collision/gpu/tree_build/gpu_trees.h"
#include "collision/problem/collision_problem.h"
#include "collision/trees/object_tree.h"
#include "gpu/buffer.h"

namespace gpu_planning_scene::core
{
/// A collision problem in GPU memory: the trees of all distinct shapes, the instances, the tree over world instances,
/// and the checked pairs. Used on the context's thread.
class GpuScene
{
 public:
  explicit GpuScene(const std::string& shader_folder) : trees_(shader_folder) {}

  /// Uploads a problem and builds the trees that do not exist yet. Throws Error if the problem is too large for the
  /// device; the scene is then unusable until the next setProblem.
  void setProblem(const CollisionProblem& problem);

  /// Restricts the checked pairs to the pairs of `problem`, which must have the same trees and instances as the
  /// uploaded one.
  void selectPairs(const CollisionProblem& problem);

  /// Binds the textures of the kernels: nodes, triangles, world poses, instances, the object tree, pairs.
  void bind() const;
  const Buffer& components() const { return trees_.components(); }
  const Buffer& leafOrder() const { return trees_.leafOrder(); }
  const Buffer& triangleRoles() const { return trees_.triangleRoles(); }
  const Buffer& halfSpaces() const { return half_spaces_; }
  const Buffer& halfSpacePairs() const { return half_space_pairs_; }

  std::uint32_t robotCount() const { return robot_count_; }
  std::uint32_t worldCount() const { return world_count_; }
  std::uint32_t halfSpaceCount() const { return half_space_count_; }
  /// The index of the first node of the primitives that are tested as solids, with one node for each instance. 0: none.
  std::uint32_t solidNodes() const { return solid_nodes_; }
  /// In metres; 0: exact.
  /// Whether some pairs have a required distance.
  bool isPadded() const { return padded_; }
  /// Whether a part of a mesh bounds a solid.
  bool hasMeshSolids() const { return has_mesh_solids_; }
  /// Upper bound of the number of levels of a tree.
  std::uint32_t depthBound() const { return trees_.depth(); }

  /// Reads the problem's trees back from the GPU, in the form for the CPU.
  Forest readForest() const;

 private:
  void writeWorld(const CollisionProblem& problem);
  void writeInstances(const CollisionProblem& problem);
  void writeSolids(const CollisionProblem& problem);
  void writeHalfSpaces(const CollisionProblem& problem);

  GpuTrees trees_;
  ObjectTree object_tree_;
  TexelBuffer world_poses_, instances_, object_nodes_, world_pairs_;
  Buffer half_spaces_, half_space_pairs_;
  std::size_t tree_count_ = 0;
  std::uint32_t robot_count_ = 0;
  std::uint32_t world_count_ = 0;
  std::uint32_t half_space_count_ = 0;
  std::uint32_t solid_nodes_ = 0;
  bool padded_ = false;
  bool has_mesh_solids_ = false;
};

/// Writes the rows of the matrix [rotation | translation] as the shaders read them (shaders/geometry/pose.glsl).
void writePoseRows(const Eigen::Isometry3d& pose, float* rows);
}  // namespace gpu_planning_scene::core
