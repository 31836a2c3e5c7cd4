#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
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

/// `count` boxes in a ring around `center`, turned, at different heights; their edges up to `size` long.
std::vector<WorldObject> boxesAround(const Eigen::Vector3d& center, std::size_t count, double radius, double size);

/// Boards, sides and a back, open towards -x. `center`: of its foot.
std::vector<WorldObject> shelf(const Eigen::Vector3d& center, const Eigen::Vector3d& size, std::size_t boards);

/// A top on four legs, and three things on it. `center`: of its top's surface; `size`: with the legs.
std::vector<WorldObject> table(const Eigen::Vector3d& center, const Eigen::Vector3d& size);

/// Two walls along x, a lintel across them and a post between; its inner size.
std::vector<WorldObject> corridor(const Eigen::Vector3d& center, const Eigen::Vector3d& size);

/// A closed mesh of about `triangles` triangles: rings of vertices from one end, `along` = 0, to the other, 1, where it
/// closes to a point. `ratio`: of its girth to its length. `position(along, angle)`: in metres.
std::shared_ptr<const Mesh> closedSurface(const std::string& name, std::size_t triangles, double ratio,
                                          const std::function<Eigen::Vector3d(double, double)>& position);

/// A torus around z: a closed mesh with a hole.
std::shared_ptr<const Mesh> torusMesh(double radius, double tube_radius);

/// A wavy square sheet: an open mesh.
std::shared_ptr<const Mesh> sheetMesh(double size);
}  // namespace gpu_planning_scene::core
