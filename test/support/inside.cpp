#include "support/inside.h"

#include <cmath>

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

bool rayCrosses(const Vector3d& origin, const Vector3d& direction, const Vector3d& a, const Vector3d& b,
                const Vector3d& c)
{
  // Barycentric coordinates of the point where the ray's line crosses the triangle's plane.
  Eigen::Matrix3d sides;
  sides << a - b, a - c, direction;
  const double determinant = sides.determinant();
  if (determinant == 0.0)
    return false;
  const Vector3d solution = sides.inverse() * (a - origin);
  return solution.x() >= 0.0 && solution.y() >= 0.0 && solution.x() + solution.y() <= 1.0 && solution.z() > 0.0;
}

bool isInsideMesh(const Mesh& mesh, const Vector3d& point)
{
  const std::array<Vector3d, 3> directions = {Vector3d(0.31, 0.57, 0.76), Vector3d(-0.83, 0.44, 0.34),
                                              Vector3d(0.12, -0.71, -0.69)};
  int odd = 0;
  for (const Vector3d& direction : directions)
  {
    int crossings = 0;
    for (const auto& t : mesh.triangles)
      crossings += rayCrosses(point, direction, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]) ? 1 : 0;
    odd += crossings % 2;
  }
  return odd >= 2;
}
}  // namespace

bool isInside(const Shape& shape, const Vector3d& p)
{
  if (const auto* box = std::get_if<Box>(&shape))
    return (2.0 * p.cwiseAbs().array() <= box->size.array()).all();
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    return p.norm() <= sphere->radius;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    return std::hypot(p.x(), p.y()) <= cylinder->radius && std::abs(p.z()) <= 0.5 * cylinder->length;
  if (const auto* cone = std::get_if<Cone>(&shape))
  {
    const double height = 0.5 * cone->length - p.z();  // below the apex
    return height <= cone->length && std::hypot(p.x(), p.y()) * cone->length <= cone->radius * height;
  }
  return isInsideMesh(*std::get<std::shared_ptr<const Mesh>>(shape), p);
}

bool hasVertexInside(const Mesh& mesh, const Eigen::Isometry3d& pose, const Shape& shape)
{
  // The bounding box of the mesh excludes most vertices without tracing rays.
  Eigen::AlignedBox3d box;
  if (const auto* other = std::get_if<std::shared_ptr<const Mesh>>(&shape))
    for (const Vector3d& vertex : (*other)->vertices)
      box.extend(vertex);
  for (const Vector3d& vertex : mesh.vertices)
  {
    const Vector3d point = pose * vertex;
    if ((box.isEmpty() || box.contains(point)) && isInside(shape, point))
      return true;
  }
  return false;
}
}  // namespace gpu_planning_scene::core
