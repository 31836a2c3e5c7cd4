#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::literature
{
/// Exact tests of the triangles that an image-space method could not discard.
class TriangleSurvivors
{
 public:
  /// Whether a triangle of `in_a` and a triangle of `in_b` have a common point. Triangles are indices into the meshes.
  bool collide(const Mesh& a, const std::vector<std::uint32_t>& in_a, const Mesh& b,
               const std::vector<std::uint32_t>& in_b, const Eigen::Isometry3d& b_in_a);
  double tests() const { return tests_; }  ///< the number of triangle tests so far

 private:
  double tests_ = 0.0;
};
}  // namespace gpu_planning_scene::core::literature
