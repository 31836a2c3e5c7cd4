#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core::literature
{
/// A closed mesh over a grid that wraps around in both directions. `at`: the point of the surface for angles from 0 to
/// 2 pi. Triangles are counterclockwise from outside if the direction of u, the direction of v and the outside form a
/// right-handed frame.
inline std::shared_ptr<const Mesh> wrappedGrid(std::uint32_t around, std::uint32_t across,
                                               const std::function<Eigen::Vector3d(double u, double v)>& at)
{
  auto mesh = std::make_shared<Mesh>();
  const auto index = [&](std::uint32_t i, std::uint32_t k) { return i % around * across + k % across; };
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t k = 0; k < across; ++k)
    {
      mesh->vertices.push_back(at(2.0 * M_PI * i / around, 2.0 * M_PI * k / across));
      mesh->triangles.push_back({index(i, k), index(i + 1, k), index(i + 1, k + 1)});
      mesh->triangles.push_back({index(i, k), index(i + 1, k + 1), index(i, k + 1)});
    }
  return mesh;
}

/// A torus around z. `radius`: of the circle in the middle of the tube.
inline std::shared_ptr<const Mesh> torusMesh(double radius, double tube, std::uint32_t around = 32,
                                             std::uint32_t across = 16)
{
  return wrappedGrid(
      around, across,
      [=](double u, double v)
      {
        const double away = radius + tube * std::cos(v);
        return Eigen::Vector3d(away * std::cos(u), away * std::sin(u), tube * std::sin(v));
      });
}

inline std::shared_ptr<const Mesh> boxMesh(const Eigen::Vector3d& size)
{
  return tessellate(Box{size}).mesh;
}

/// A polyhedron with its vertices on a sphere.
inline std::shared_ptr<const Mesh> sphereMesh(double radius, int rings = 12)
{
  auto mesh = std::make_shared<Mesh>();
  const int sides = 2 * rings;
  mesh->vertices = {{0.0, 0.0, -radius}, {0.0, 0.0, radius}};
  for (int ring = 1; ring < rings; ++ring)
    for (int side = 0; side < sides; ++side)
    {
      const double down = M_PI * ring / rings;
      const double around = 2.0 * M_PI * side / sides;
      mesh->vertices.push_back(radius * Eigen::Vector3d(std::sin(down) * std::cos(around),
                                                        std::sin(down) * std::sin(around), -std::cos(down)));
    }
  const auto at = [&](int ring, int side) { return static_cast<std::uint32_t>(2 + (ring - 1) * sides + side % sides); };
  for (int side = 0; side < sides; ++side)
  {
    mesh->triangles.push_back({0, at(1, side + 1), at(1, side)});
    mesh->triangles.push_back({1, at(rings - 1, side), at(rings - 1, side + 1)});
    for (int ring = 1; ring + 1 < rings; ++ring)
    {
      mesh->triangles.push_back({at(ring, side), at(ring, side + 1), at(ring + 1, side + 1)});
      mesh->triangles.push_back({at(ring, side), at(ring + 1, side + 1), at(ring + 1, side)});
    }
  }
  return mesh;
}
}  // namespace gpu_planning_scene::core::literature
