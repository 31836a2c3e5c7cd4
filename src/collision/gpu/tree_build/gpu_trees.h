#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "collision/gpu/tree_build/built_trees.h"
#include "collision/gpu/tree_build/gpu_forest.h"
#include "collision/gpu/tree_build/gpu_oriented_boxes.h"
#include "gpu/buffer.h"
#include "gpu_planning_scene/solids.h"

namespace gpu_planning_scene::core
{
/// The trees of shapes in GPU memory, kept from scene to scene. Only the trees of new shapes are built. Unused trees
/// are dropped when they take half of the memory. Used on the context's thread.
class GpuTrees
{
 public:
  /// The data of a tree for the shaders.
  struct Tree
  {
    std::uint32_t root = 0;             ///< node
    std::uint32_t first_component = 0;  ///< see shaders/problem/components.glsl
    std::uint32_t component_count = 0;  ///< 0: too many
    bool has_solid = false;             ///< a part of the mesh bounds a solid
    Eigen::AlignedBox3d bounds;         ///< bounds of the triangles, in the shape's frame
  };

  explicit GpuTrees(const std::string& shader_folder) : builder_(shader_folder), oriented_boxes_(shader_folder) {}

  /// Makes tree(i) the tree of `shapes[i]`. Meshes are compared by pointer: a mesh that had a tree before has the same
  /// tree now. Throws Error if the device cannot hold the trees or has built wrong ones; all trees are then gone.
  void setShapes(const std::vector<Tessellation>& shapes);

  const Tree& tree(std::size_t number) const { return chosen_[number]->tree; }
  /// Upper bound of the number of levels of a tree.
  std::uint32_t depth() const { return depth_; }

  /// Stores the caller's nodes beside the nodes of the trees, with their axis-aligned boxes as oriented boxes. Returns
  /// the index of the first one, which is valid until the next call of this function or of setShapes.
  std::uint32_t placeNodes(const std::vector<Node>& nodes);

  const TexelBuffer& nodes() const { return nodes_; }
  const TexelBuffer& orientedNodes() const { return oriented_nodes_; }  ///< at the indices of the nodes
  const TexelBuffer& triangles() const { return triangles_; }
  const Buffer& leafOrder() const { return leaf_order_; }  ///< triangles are numbered across all trees
  const Buffer& components() const { return components_; }
  const Buffer& triangleRoles() const { return triangle_roles_; }  ///< two bits by triangle number

  /// Reads the trees with the given numbers back from the GPU, in the form for the CPU.
  Forest readForest(const std::vector<std::size_t>& numbers) const;

 private:
  /// A mesh, and a number that tells several trees over the same mesh apart; there are several if trees are not shared.
  using Key = std::pair<const Mesh*, std::uint32_t>;
  struct Entry
  {
    std::shared_ptr<const Mesh> mesh;  // keeps the mesh alive, so that no other mesh gets its address
    std::shared_ptr<const SolidMesh> solid;
    Tree tree;
    std::size_t build = 0;             // index into builds_
    std::uint32_t first_triangle = 0;  // number of its first triangle
    bool used = false;
  };

  /// Returns the keys that have no entry yet.
  std::vector<Key> claim(const std::vector<Key>& keys, const std::vector<Tessellation>& shapes);
  void build(const std::vector<Key>& keys);
  BuiltTrees read(const ForestRegion& region) const;
  void addComponents(Entry& entry);
  void clear();

  GpuForestBuilder builder_;
  GpuOrientedBoxes oriented_boxes_;
  TexelBuffer nodes_, oriented_nodes_, triangles_;
  Buffer leaf_order_, components_, triangle_roles_;
  std::map<Key, Entry> entries_;
  std::vector<Key> keys_;             // keys of the current shapes
  std::vector<const Entry*> chosen_;  // entries of the current shapes
  std::vector<ForestRegion> builds_;
  std::vector<std::array<float, 4>> component_records_;
  std::vector<std::uint32_t> role_bits_;
  std::uint32_t node_count_ = 0;       // nodes in use
  std::uint32_t primitive_count_ = 0;  // primitives in use
  std::uint32_t reserved_first_ = 0;   // place reserved by placeNodes
  std::size_t reserved_ = 0;
  std::uint32_t depth_ = 1;
};
}  // namespace gpu_planning_scene::core
