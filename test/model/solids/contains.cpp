#include "model/solids/contains.h"

#include <cmath>
#include <cstddef>
#include <memory>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "support/inside.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// The solid angle of a triangle at the origin (van Oosterom and Strackee 1983).
double solidAngle(const Vector3d& a, const Vector3d& b, const Vector3d& c)
{
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

bool contains(const SolidMesh& solid, const Vector3d& point)
{
  double winding = 0.0;
  Mesh parity;
  parity.vertices = solid.mesh->vertices;
  for (std::size_t i = 0; i < solid.roles.size(); ++i)
  {
    const auto& t = solid.mesh->triangles[i];
    const auto corner = [&](std::size_t k) -> Vector3d { return solid.mesh->vertices[t[k]] - point; };
    if (solid.roles[i] == TriangleRole::Winding)
      winding += solidAngle(corner(0), corner(1), corner(2)) / (4.0 * M_PI);
    else if (solid.roles[i] == TriangleRole::Parity)
      parity.triangles.push_back(t);
  }
  EXPECT_NEAR(winding, std::round(winding), 1e-6) << "the triangles are not closed";
  return std::lround(winding) != 0 || isInside(std::make_shared<const Mesh>(parity), point);
}
}  // namespace gpu_planning_scene::core
