#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "collision_problem.h"
#include "components.h"
#include "forest.h"
#include "triangle_pair.h"

namespace gpu_planning_scene
{
inline Eigen::Vector3d centerOf(const Node& node)
{
  return {node.center[0], node.center[1], node.center[2]};
}
inline Eigen::Vector3d halfOf(const Node& node)
{
  return {node.half[0], node.half[1], node.half[2]};
}

/// The trees of a collision problem with what the CPU's queries want to know of them, laid out for these. Immutable.
class CpuForest
{
 public:
  struct Tree
  {
    std::uint32_t root;
    Eigen::Vector3d center;  ///< of a box that holds the shape: its true surface, not only its tessellation
    Eigen::Vector3d half;
    bool mesh;
    std::vector<Component> components;  ///< of a mesh
    Eigen::AlignedBox3d solid_bounds;   ///< of the closed ones together; empty if there are none
  };

  /// `forest` holds a valid tree for each of the problem's trees.
  CpuForest(const CollisionProblem& problem, std::shared_ptr<const Forest> forest);

  const Tree& tree(std::uint32_t number) const { return trees_[number]; }
  const Shape& shape(std::uint32_t tree) const { return shapes_[tree]; }
  const Node& node(std::uint32_t number) const { return forest_->nodes[number]; }

  /// By place in the forest's leaf_triangles, as leaves have them.
  const Triangle& triangle(std::uint32_t place) const { return triangles_[place]; }
  /// Whether that triangle is one of a closed component.
  bool boundsSolid(std::uint32_t place) const { return bounds_solid_[place] != 0; }

 private:
  std::shared_ptr<const Forest> forest_;
  std::vector<Shape> shapes_;
  std::vector<Tree> trees_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint8_t> bounds_solid_;
};
}  // namespace gpu_planning_scene
