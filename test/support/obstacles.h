#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene
{
/// Where generated obstacles lie: their centres in a spherical shell, their sizes up to `size` (all in metres).
struct ObstacleField
{
  std::size_t count;
  Eigen::Vector3d center;
  double inner_radius;
  double outer_radius;
  double size;
};

/// Obstacles of every kind of shape, closed and open meshes among them, in random poses. The same for the same seed.
std::vector<WorldObject> generateObstacles(const ObstacleField& field, std::uint64_t seed);

/// A torus around z: a closed mesh with a hole.
std::shared_ptr<const Mesh> torusMesh(double radius, double tube_radius);

/// A wavy square sheet: an open mesh.
std::shared_ptr<const Mesh> sheetMesh(double size);
}  // namespace gpu_planning_scene
