#include "literature/trees/triangle_overlap.h"

#include <algorithm>

// The separating axis test of two triangles with 17 axes (S. Gottschalk, "Collision Queries using Oriented Bounding
// Boxes", 2000). All trees of this folder use it, so that they differ by their bounding volumes alone.
namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Vector3d;

bool separates(const Vector3d& axis, const Triangle& a, const Triangle& b)
{
  const auto [a_min, a_max] = std::minmax({axis.dot(a[0]), axis.dot(a[1]), axis.dot(a[2])});
  const auto [b_min, b_max] = std::minmax({axis.dot(b[0]), axis.dot(b[1]), axis.dot(b[2])});
  return a_max < b_min || b_max < a_min;
}
}  // namespace

std::vector<Triangle> trianglesOf(const Mesh& mesh)
{
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    triangles.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  return triangles;
}

bool trianglesOverlap(const Triangle& placed_a, const Triangle& placed_b)
{
  // Coordinates relative to one corner lose fewer bits.
  const Vector3d& corner = placed_a[0];
  const Triangle a = {Vector3d::Zero(), placed_a[1] - corner, placed_a[2] - corner};
  const Triangle b = {placed_b[0] - corner, placed_b[1] - corner, placed_b[2] - corner};
  const std::array<Vector3d, 3> edges_a = {a[1] - a[0], a[2] - a[1], a[0] - a[2]};
  const std::array<Vector3d, 3> edges_b = {b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  const Vector3d normal_a = edges_a[0].cross(edges_a[1]);
  const Vector3d normal_b = edges_b[0].cross(edges_b[1]);
  if (separates(normal_a, a, b) || separates(normal_b, a, b))
    return false;
  for (const Vector3d& edge_a : edges_a)
    for (const Vector3d& edge_b : edges_b)
      if (separates(edge_a.cross(edge_b), a, b))
        return false;
  for (int i = 0; i < 3; ++i)
    if (separates(normal_a.cross(edges_a[i]), a, b) || separates(normal_b.cross(edges_b[i]), a, b))
      return false;
  return true;
}
}  // namespace gpu_planning_scene::core::literature
