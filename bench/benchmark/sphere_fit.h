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

/// At most `count` balls that cover samples of a surface. The candidates are inner balls that touch the surface on both
/// sides. All chosen balls are enlarged by the same length, the smallest length with which they cover the samples.
/// After Bradshaw and O'Sullivan, "Adaptive medial-axis approximation for sphere-tree construction" (2004).
/// Deterministic.
std::vector<Ball> fitBalls(const Mesh& mesh, std::size_t count);

/// A bounding ball of a mesh, with the centre of the mesh's bounding box.
Ball boundingBall(const Mesh& mesh);
}  // namespace gpu_planning_scene::core::benchmark
