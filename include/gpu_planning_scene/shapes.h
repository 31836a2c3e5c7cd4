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
/// Largest allowed coordinate, size or padding, in metres. Far beyond it, squares overflow and doubles no longer
/// resolve micrometres.
constexpr double kLargestLength = 1e6;

/// Which points a mesh has inside.
enum class SolidRule : std::uint8_t
{
  Auto,     ///< parts that are closed, or whose holes are small, bound solids; others are surfaces (solidMeshOf)
  Surface,  ///< none: the mesh is a surface
  Filled,   ///< all holes are filled, so each part bounds a solid
};

/// "auto", "surface" or "filled". solidRuleFrom throws Error for any other name.
SolidRule solidRuleFrom(const std::string& name);
std::string toString(SolidRule rule);

/// A triangle mesh in metres, in its own frame. Any topology is allowed. A mesh may be open or cracked. Duplicate
/// triangles and triangles of zero area are surfaces like all others. solidMeshOf (solids.h) says what it has inside.
/// Vertices are finite and indices in range; the loaders and `validateMesh` ensure this. Immutable once shared.
struct Mesh
{
  std::string name;  ///< origin of the mesh, for messages: a file, or the object that has it
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  SolidRule solid = SolidRule::Auto;  ///< which points it has inside
};

/// Throws Error if the mesh has no triangle, a coordinate that is not finite or beyond kLargestLength, or an index out
/// of range.
void validateMesh(const Mesh& mesh);

/// Solids in their own frame, centred at its origin, in metres (as in shape_msgs/SolidPrimitive).
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

/// All points x with normal . x <= offset (as in fcl::Halfspace); `normal` has unit length. Only world objects can have
/// half-spaces.
struct HalfSpace
{
  Eigen::Vector3d normal;
  double offset;  ///< metres
};

/// The shape of a body. Meshes are shared: shapes with the same pointer are instances of one tree.
using Shape = std::variant<Box, Sphere, Cylinder, Cone, std::shared_ptr<const Mesh>, HalfSpace>;

/// Throws Error if a dimension is not finite, not positive or above kLargestLength, if a normal does not have unit
/// length, or if a mesh is not valid. `where` names the shape in the message.
void validateShape(const Shape& shape, const std::string& where);

/// A shape and its pose in the frame of its body (link or object).
struct PlacedShape
{
  Shape shape;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

/// Gives all meshes of the shapes this rule. Shapes that shared a mesh share its copy. Returns whether a mesh had
/// another rule.
bool setSolidRule(std::vector<PlacedShape>& shapes, SolidRule rule);

struct SolidMesh;  // solids.h

/// The surface of a shape as triangles inside its solid, and the largest distance from the true surface to the
/// triangles.
struct Tessellation
{
  std::shared_ptr<const Mesh>
      mesh;              ///< inscribed: all vertices are on the true surface. Of a mesh: with its holes filled
  double sagitta = 0.0;  ///< metres; 0 for boxes and meshes, which are exact
  std::shared_ptr<const SolidMesh> solid = nullptr;  ///< of a mesh: see solidMeshOf
};

/// Makes triangles of the surface of a shape. The sagitta of curved shapes is at most 100 micrometres, unless that
/// takes more than 2^15 triangles. Throws std::logic_error for a half-space, which has no finite surface.
Tessellation tessellate(const Shape& shape);
}  // namespace gpu_planning_scene::core
