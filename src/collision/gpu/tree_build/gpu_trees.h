#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "collision/gpu/tree_build/gpu_forest.h"
#include "collision/gpu/tree_build/gpu_oriented_boxes.h"
#include "gpu/buffer.h"

namespace gpu_planning_scene::core
{
/// The trees of shapes in GPU memory. They stay from one scene to the next: only those of new shapes are built, and
/// those of shapes that are gone are dropped once they take half of the memory. Used on the context's thread.
class GpuTrees
{
 public:
  /// What the shaders need to know of a tree.
  struct Tree
  {
    std::uint32_t root = 0;             ///< node
    std::uint32_t first_component = 0;  ///< see shaders/problem/components.glsl
    std::uint32_t component_count = 0;  ///< 0: too many
    bool has_solid = false;             ///< some components are closed
    Eigen::AlignedBox3d bounds;         ///< of the triangles, in the shape's frame
  };

  explicit GpuTrees(const std::string& shader_folder) : builder_(shader_folder), oriented_boxes_(shader_folder) {}

  /// Makes tree(i) that of `shapes[i]`. Equal meshes, by pointer, have had equal trees before and have them now. Throws
  /// Error where the device cannot hold them; all trees are gone then.
  void setShapes(const std::vector<Tessellation>& shapes);

  const Tree& tree(std::size_t number) const { return chosen_[number]->tree; }
  /// No tree has more levels than this.
  std::uint32_t depth() const { return depth_; }

  /// Puts nodes of the caller's beside those of the trees, with their boxes for oriented ones, and returns where the
  /// first one lies; the place holds until the next call of this or of setShapes.
  std::uint32_t placeNodes(const std::vector<Node>& nodes);

  const TexelBuffer& nodes() const { return nodes_; }
  const TexelBuffer& orientedNodes() const { return oriented_nodes_; }  ///< in the places of the nodes
  const TexelBuffer& triangles() const { return triangles_; }
  const Buffer& leafOrder() const { return leaf_order_; }  ///< triangles are numbered through all trees
  const Buffer& components() const { return components_; }
  const Buffer& solidTriangles() const { return solid_triangles_; }  ///< bits by a triangle's number

  /// The trees as the CPU can walk them, by their numbers; reads back from the GPU.
  Forest readForest(const std::vector<std::size_t>& numbers) const;

 private:
  /// A mesh, and which of the problem's trees over this mesh it is where they are not shared.
  using Key = std::pair<const Mesh*, std::uint32_t>;
  struct Entry
  {
    std::shared_ptr<const Mesh> mesh;  // so that no other mesh gets its address
    Tree tree;
    std::size_t build = 0;             // it was built with
    std::uint32_t first_triangle = 0;  // its number
    bool used = false;
  };

  /// Returns the keys that have no entry yet.
  std::vector<Key> claim(const std::vector<Key>& keys, const std::vector<Tessellation>& shapes);
  void build(const std::vector<Key>& keys);
  void addComponents(Entry& entry);
  void clear();

  GpuForestBuilder builder_;
  GpuOrientedBoxes oriented_boxes_;
  TexelBuffer nodes_, oriented_nodes_, triangles_;
  Buffer leaf_order_, components_, solid_triangles_;
  std::map<Key, Entry> entries_;
  std::vector<Key> keys_;             // of the current shapes
  std::vector<const Entry*> chosen_;  // likewise
  std::vector<ForestRegion> builds_;
  std::vector<std::array<float, 4>> component_records_;
  std::vector<std::uint32_t> solid_bits_;
  std::uint32_t node_count_ = 0;       // taken so far
  std::uint32_t primitive_count_ = 0;  // likewise
  std::uint32_t reserved_first_ = 0;   // by placeNodes
  std::size_t reserved_ = 0;
  std::uint32_t depth_ = 1;
};
}  // namespace gpu_planning_scene::core
