#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::benchmark
{
struct Ball
{
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  float radius = 0.0F;
};

/// Balls that cover a surface, up to what lies between its samples: the samples are put into `count` clusters by
/// Lloyd's algorithm, from centres far from each other, and each cluster gets its smallest enclosing ball (Badoiu and
/// Clarkson, "Smaller core-sets for balls", 2003). The same for the same mesh.
std::vector<Ball> fitBalls(const Mesh& mesh, std::size_t count);

/// A ball around all of a mesh, its centre that of the mesh's box.
Ball boundingBall(const Mesh& mesh);
}  // namespace gpu_planning_scene::benchmark
