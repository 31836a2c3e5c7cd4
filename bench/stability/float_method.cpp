#include <algorithm>
#include <array>

#include "stability/peers.h"

namespace gpu_planning_scene::core::stability
{
namespace
{
using FloatTriangle = std::array<Eigen::Vector3f, 3>;

std::vector<FloatTriangle> trianglesOf(const Shape& shape, const Eigen::Isometry3d& pose)
{
  const Eigen::Isometry3f rounded = pose.cast<float>();
  const std::shared_ptr<const Mesh> mesh = tessellate(shape).mesh;
  std::vector<FloatTriangle> triangles;
  for (const auto& t : mesh->triangles)
  {
    FloatTriangle placed;
    for (int i = 0; i < 3; ++i)
      placed[i] = rounded * mesh->vertices[t[i]].cast<float>();
    triangles.push_back(placed);
  }
  return triangles;
}

bool separates(const Eigen::Vector3f& axis, const FloatTriangle& a, const FloatTriangle& b)
{
  const auto [a_min, a_max] = std::minmax({axis.dot(a[0]), axis.dot(a[1]), axis.dot(a[2])});
  const auto [b_min, b_max] = std::minmax({axis.dot(b[0]), axis.dot(b[1]), axis.dot(b[2])});
  return a_max < b_min || b_max < a_min;
}

/// The separating axis test of two triangles with 17 axes: two normals, nine products of edges, and the in-plane
/// normals of the six edges.
bool overlap(const FloatTriangle& a, const FloatTriangle& b)
{
  const std::array<Eigen::Vector3f, 3> edges_a = {a[1] - a[0], a[2] - a[1], a[0] - a[2]};
  const std::array<Eigen::Vector3f, 3> edges_b = {b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  const Eigen::Vector3f normal_a = edges_a[0].cross(edges_a[1]);
  const Eigen::Vector3f normal_b = edges_b[0].cross(edges_b[1]);
  if (separates(normal_a, a, b) || separates(normal_b, a, b))
    return false;
  for (int i = 0; i < 3; ++i)
  {
    if (separates(normal_a.cross(edges_a[i]), a, b) || separates(normal_b.cross(edges_b[i]), a, b))
      return false;
    for (int k = 0; k < 3; ++k)
      if (separates(edges_a[i].cross(edges_b[k]), a, b))
        return false;
  }
  return true;
}
}  // namespace

bool floatCollides(const Case& c)
{
  const std::vector<FloatTriangle> b = trianglesOf(c.b, c.pose_b);
  for (const FloatTriangle& triangle : trianglesOf(c.a, c.link_a * c.a_in_link))
    if (std::any_of(b.begin(), b.end(), [&](const FloatTriangle& other) { return overlap(triangle, other); }))
      return true;
  return false;
}
}  // namespace gpu_planning_scene::core::stability
