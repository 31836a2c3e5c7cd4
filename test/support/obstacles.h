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
/// The region and size of generated obstacles: their centres lie in a spherical shell, their sizes are at most `size`.
/// All lengths in metres.
struct ObstacleField
{
  std::size_t count;
  Eigen::Vector3d center;
  double inner_radius;
  double outer_radius;
  double size;
};

/// Obstacles of every kind of shape, including closed and open meshes, in random poses. The same seed gives the same
/// obstacles.
std::vector<WorldObject> generateObstacles(const ObstacleField& field, std::uint64_t seed);

/// `count` rotated boxes in a ring around `center`, at different heights. Their longest edge is `size`.
std::vector<WorldObject> boxesAround(const Eigen::Vector3d& center, std::size_t count, double radius, double size);

/// A shelf with boards, sides and a back, open towards -x. `center`: the centre of its foot.
std::vector<WorldObject> shelf(const Eigen::Vector3d& center, const Eigen::Vector3d& size, std::size_t boards);

/// A table top on four legs, with three objects on it. `center`: the centre of the top surface; `size`: including legs.
std::vector<WorldObject> table(const Eigen::Vector3d& center, const Eigen::Vector3d& size);

/// Two walls along x, a lintel across them and a post between them. `size`: the inner size.
std::vector<WorldObject> corridor(const Eigen::Vector3d& center, const Eigen::Vector3d& size);

/// A closed mesh of about `triangles` triangles. Rings of vertices run from one end (`along` = 0) to the other (`along`
/// = 1); both ends are single points. `ratio`: girth divided by length. `position(along, angle)`: in metres.
std::shared_ptr<const Mesh> closedSurface(const std::string& name, std::size_t triangles, double ratio,
                                          const std::function<Eigen::Vector3d(double, double)>& position);

/// A torus around z: a closed mesh with a hole.
std::shared_ptr<const Mesh> torusMesh(double radius, double tube_radius);

/// A wavy square sheet: an open mesh.
std::shared_ptr<const Mesh> sheetMesh(double size);
}  // namespace gpu_planning_scene::core
