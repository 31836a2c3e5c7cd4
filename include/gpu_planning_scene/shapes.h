#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

namespace gpu_planning_scene::core
{
/// Metres: no coordinate, size or padding may be larger. Far beyond it, squares overflow, and doubles have no
/// micrometres.
constexpr double kLargestLength = 1e6;

/// A triangle mesh in metres, in its own frame. No demand is made on topology: open, cracked, duplicate and zero-area
/// triangles are surfaces like any other. Vertices are finite and indices in range (the loaders and
/// `validateMesh` see to it). Immutable once shared.
struct Mesh
{
  std::string name;  ///< where it came from, for messages: a file, or the object that carried it
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Throws Error if the mesh has no triangle, a coordinate that is not finite or above kLargestLength, or an index out
/// of range.
void validateMesh(const Mesh& mesh);

/// Solids in their own frame, centred at its origin, in metres (as shape_msgs/SolidPrimitive has them).
struct Box
{
  Eigen::Vector3d size;  ///< full edge lengths along x, y, z
};
struct Sphere
{
  double radius;
};
struct Cylinder
{
  double radius;
  double length;  ///< along z
};
struct Cone
{
  double radius;  ///< of the base, at z = -length / 2
  double length;  ///< along z; the apex is at z = +length / 2
};

/// All points x with normal . x <= offset (as fcl::Halfspace has them); `normal` has unit length. Only world objects
/// can have one.
struct HalfSpace
{
  Eigen::Vector3d normal;
  double offset;  ///< metres
};

/// Meshes are shared: two shapes with the same pointer are instances of one tree.
using Shape = std::variant<Box, Sphere, Cylinder, Cone, std::shared_ptr<const Mesh>, HalfSpace>;

/// Throws Error if a dimension is not finite and positive, or a normal not of unit length; `where` names the shape in
/// the message.
void validateShape(const Shape& shape, const std::string& where);

/// A shape with its pose in the frame of the body (link or object) that it belongs to.
struct PlacedShape
{
  Shape shape;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

/// A surface that lies inside the shape's solid, and how far the true surface may be outside of it.
struct Tessellation
{
  std::shared_ptr<const Mesh> mesh;  ///< inscribed: its vertices lie on the true surface
  double sagitta = 0.0;              ///< metres; 0 for boxes and meshes, which are represented exactly
};

/// The surface of a shape as triangles. Curved shapes are cut so finely that the sagitta is at most 100 micrometres,
/// or as finely as 2^15 triangles go. Throws std::logic_error for a half-space, which has no finite surface.
Tessellation tessellate(const Shape& shape);
}  // namespace gpu_planning_scene::core
