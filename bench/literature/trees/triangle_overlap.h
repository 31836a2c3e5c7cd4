#pragma once

#include <vector>

#include "collision/geometry/triangle_pair.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::literature
{
std::vector<Triangle> trianglesOf(const Mesh& mesh);

inline Triangle moved(const Triangle& t, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation)
{
  return {rotation * t[0] + translation, rotation * t[1] + translation, rotation * t[2] + translation};
}

inline Eigen::Vector3d centroid(const Triangle& t)
{
  return (t[0] + t[1] + t[2]) / 3.0;
}

/// Whether no axis separates two triangles, in double and without error bounds: the two normals, the nine products of
/// edges, and the six normals of the edges within their planes.
bool trianglesOverlap(const Triangle& a, const Triangle& b);
}  // namespace gpu_planning_scene::core::literature
