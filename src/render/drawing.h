#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core
{
using BodyColor = std::array<std::uint8_t, 4>;  ///< red, green, blue, opacity

constexpr BodyColor kCollidingColor{224, 45, 45, 255};        // links and attached objects
constexpr BodyColor kCollidingObjectColor{138, 16, 30, 255};  // objects; darker, so that the robot stands out
constexpr BodyColor kContactColor{255, 221, 0, 255};

/// At most this many contacts of a pair of bodies are drawn. More would merge on the screen.
constexpr std::size_t kMaxContactsOfPair = 5;

/// The colour of a body that does not collide: its colour in the scene (object_colors) if it has one, else a default.
BodyColor bodyColor(const PlanningScene& scene, std::size_t body);

/// The colour of a body that collides: red, and dark red for objects of the world.
BodyColor collidingColor(const PlanningScene& scene, std::size_t body);

/// The colour of triangles that bound no solid, on a body of this colour: a tinge of violet. Bodies that collide have
/// no such tinge, so that they stay red.
BodyColor openColor(const BodyColor& color);

/// The shapes of a link, an object or an attached object.
const std::vector<PlacedShape>& bodyShapes(const PlanningScene& scene, std::size_t body);

/// All bodies of the pairs.
std::set<std::size_t> bodiesOf(const std::vector<BodyPair>& pairs);

/// A corner of a triangle, as shaders/draw/draw.vert reads it.
struct DrawnVertex
{
  std::array<float, 3> position;  ///< metres, in the planning frame
  std::array<float, 3> normal;    ///< of its triangle, of unit length
  BodyColor color;
};

/// The pose of each body in the planning frame, in the order links, objects, attached objects.
std::vector<Eigen::Isometry3d> bodyPoses(const PlanningScene& scene, const double* state);

/// The bounding box of a body's shapes in the planning frame. Half-spaces have no bounding box.
Eigen::AlignedBox3d bodyBounds(const PlanningScene& scene, int body, const Eigen::Isometry3d& pose);

/// The diameter of the spheres at contact points, in metres. A sphere is small beside the smallest colliding body, for
/// example a finger, but still visible in a picture of `near`. `poses`: of all bodies.
double contactDiameter(const PlanningScene& scene, const std::vector<Eigen::Isometry3d>& poses,
                       const std::vector<BodyPair>& colliding, const Eigen::AlignedBox3d& near);

/// A disc that shows where the scene's lowest point is. It is not part of the scene.
struct Floor
{
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< in the planning frame
  double radius = 0.0;                               ///< metres; 0: no floor
};

/// The vertices of a link or of an attached object.
struct RobotPart
{
  std::size_t begin = 0;
  std::size_t end = 0;
  bool collides = false;
};

/// Triangles, three corners each. In this order: links, objects, attached objects, contact points, floor.
struct Drawing
{
  std::vector<DrawnVertex> vertices;
  std::size_t links_end = 0;
  std::size_t objects_end = 0;
  std::size_t bodies_end = 0;
  std::size_t contacts_end = 0;
  std::vector<RobotPart> robot;  ///< links and attached objects with shapes
  Floor floor;
};

/// Draws all bodies: links grey, attached objects green, objects in several colours, unless the scene gives them a
/// colour. Bodies of `colliding` pairs are red. Then it draws the contact points as small yellow spheres, which mostly
/// lie inside the bodies. A half-space is drawn as a square with the diagonal of nearRobot as its edge. A scene without
/// a half-space gets a floor, at right angles to `up`, below all bodies near the robot.
Drawing drawingOf(const PlanningScene& scene, const double* state, const std::vector<BodyPair>& colliding,
                  const std::vector<Eigen::Vector3d>& contact_points, const Eigen::Vector3d& up);
}  // namespace gpu_planning_scene::core
