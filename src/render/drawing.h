#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
using BodyColor = std::array<std::uint8_t, 4>;  ///< red, green, blue, opacity

constexpr BodyColor kCollidingColor{214, 39, 40, 255};
constexpr BodyColor kContactColor{255, 221, 0, 255};

/// The colour of a body that does not collide: the scene's, where it has one (object_colors).
BodyColor bodyColor(const PlanningScene& scene, std::size_t body);

/// Of a link, an object or an attached object.
const std::vector<PlacedShape>& bodyShapes(const PlanningScene& scene, std::size_t body);

/// Those of the pairs.
std::set<std::size_t> bodiesOf(const std::vector<BodyPair>& pairs);

/// A corner of a triangle, as shaders/draw/draw.vert reads it.
struct DrawnVertex
{
  std::array<float, 3> position;  ///< metres, in the planning frame
  std::array<float, 3> normal;    ///< of its triangle
  BodyColor color;
};

/// The pose of each body in the planning frame: links, objects, attached objects.
std::vector<Eigen::Isometry3d> bodyPoses(const PlanningScene& scene, const double* state);

/// Box around a body's shapes in the planning frame; half-spaces have none.
Eigen::AlignedBox3d bodyBounds(const PlanningScene& scene, int body, const Eigen::Isometry3d& pose);

/// Triangles, three corners each.
struct Drawing
{
  std::vector<DrawnVertex> vertices;
  std::size_t bodies_end = 0;  ///< what follows is seen through the bodies
};

/// All bodies: links grey, objects in their colours, those of `colliding` pairs red; then the contact points, small
/// yellow spheres, which mostly lie inside. A half-space is a square as large as what is near the robot.
Drawing drawingOf(const PlanningScene& scene, const double* state, const std::vector<BodyPair>& colliding,
                  const std::vector<Eigen::Vector3d>& contact_points);
}  // namespace gpu_planning_scene::core
