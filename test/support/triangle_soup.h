#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// A mesh of `triangles` separate triangles. Each corner is a call of `corner`. The mesh is a surface: the search for a
/// solid takes a minute for 65,000 triangles in sanitized code, and finds none. Tests of that search have other meshes.
template <class Corner>
std::shared_ptr<Mesh> triangleSoup(std::size_t triangles, const Corner& corner)
{
  auto mesh = std::make_shared<Mesh>();
  mesh->name = "soup";
  mesh->solid = SolidRule::Surface;
  for (std::uint32_t t = 0; t < triangles; ++t)
  {
    for (int i = 0; i < 3; ++i)
      mesh->vertices.push_back(corner());
    mesh->triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}
}  // namespace gpu_planning_scene::core
