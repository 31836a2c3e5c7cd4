#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "literature/method.h"
#include "literature/shared_tree.h"
#include "literature/trees/float_box.h"
#include "literature/trees/triangle_overlap.h"

namespace gpu_planning_scene::core::literature
{
/// A tree of boxes over the triangles of a mesh. Only the root has a whole box: each other node cuts one side off the
/// box of its parent.
class BoxTree
{
 public:
  struct Node
  {
    float plane = 0.0F;         ///< the new position of the side that this node moves
    std::uint32_t child = 0;    ///< the first child; of a leaf: its triangle
    std::uint8_t side = 0;      ///< 2 axis: the lower side; 2 axis + 1: the upper side
    std::uint8_t children = 0;  ///< 0: a leaf; 1: an empty side is cut off; 2
  };

  explicit BoxTree(const Mesh& mesh);
  const FloatBox& rootBox() const { return root_box_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  void build(std::uint32_t node, FloatBox box, std::uint32_t* begin, std::uint32_t* end);
  void addChild(std::uint32_t child, std::uint8_t side, float plane, FloatBox box, std::uint32_t* begin,
                std::uint32_t* end);

  std::vector<Triangle> triangles_;
  std::vector<FloatBox> bounds_;  // of each triangle; empty after the construction
  std::vector<Node> nodes_;
  FloatBox root_box_;
};

std::unique_ptr<Method> makeBoxTree(const MeshPtr& a, const MeshPtr& b);
}  // namespace gpu_planning_scene::core::literature
