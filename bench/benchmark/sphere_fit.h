#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::benchmark
{
struct Ball
{
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  float radius = 0.0F;
};

/// At most `count` balls that cover samples of a surface: of the balls inside that touch it on both sides, as many,
/// each grown by the same length, the least with which they do. After Bradshaw and O'Sullivan, "Adaptive medial-axis
/// approximation for sphere-tree construction" (2004). The same for the same mesh.
std::vector<Ball> fitBalls(const Mesh& mesh, std::size_t count);

/// A ball around all of a mesh, its centre that of the mesh's box.
Ball boundingBall(const Mesh& mesh);
}  // namespace gpu_planning_scene::core::benchmark
