#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// How a part of a mesh became a solid, or why it did not. A part is a set of triangles that are connected by edges.
enum class PartKind : std::uint8_t
{
  Closed,   ///< bounds a solid as it is in the file
  Mended,   ///< bounds a solid: triangles were turned, counted once, or joined along seams
  Filled,   ///< bounds a solid together with triangles that fill its holes
  Surface,  ///< bounds no solid: only its triangles collide
};

/// A part of a mesh.
struct MeshPart
{
  PartKind kind;
  std::size_t triangles;
  Eigen::AlignedBox3d bounds;  ///< of its triangles, in the mesh's frame
  std::size_t holes = 0;       ///< of Filled and Surface
  double largest_hole = 0.0;   ///< metres: the largest diagonal of a hole's bounding box
  double hole_share = 0.0;     ///< area of the triangles that fill the holes (m^2), as a share of the part's area
};

/// The parts of a mesh.
struct MeshParts
{
  std::size_t closed = 0;       ///< number of parts of kind Closed
  std::vector<MeshPart> other;  ///< all other parts

  std::size_t count(PartKind kind) const;
};

/// The way in which a triangle of a mesh counts for the solid.
enum class TriangleRole : std::uint8_t
{
  Surface,  ///< a surface alone
  Winding,  ///< a point is inside the solid if the winding number of all triangles of this role is not 0
  Parity,   ///< a point is inside the solid if a ray from it crosses an odd number of triangles of this role
};

/// A connected component of a mesh, in the mesh's frame.
struct Component
{
  Eigen::Vector3d point;       ///< a vertex of the component
  Eigen::AlignedBox3d bounds;  ///< of its vertices
  bool solid;                  ///< it has a triangle that counts for the solid
};

/// A mesh whose solid parts are closed, and what each triangle counts for.
struct SolidMesh
{
  /// The triangles of the original mesh in their order, some of them turned, then the triangles that close seams and
  /// fill holes. The vertices are those of the original mesh. If nothing had to be changed, the original mesh.
  std::shared_ptr<const Mesh> mesh;
  std::vector<TriangleRole> roles;    ///< one per triangle
  std::vector<Component> components;  ///< connected by vertices at equal coordinates
  MeshParts parts;

  bool hasSolid() const;
  /// Whether all triangles with three different corners count for the solid.
  bool isAllSolid() const;
  /// Whether a triangle belongs to a part that bounds no solid, for pictures: a triangle of the role Surface in a mesh
  /// with such a part.
  bool isOpen(std::size_t triangle) const;
};

/// Finds out which points a mesh has inside, and closes it where that is needed.
///
/// 1. A component whose edges each have two triangles of opposite direction is closed. All others go on.
/// 2. Vertices within a millionth of the mesh's diagonal count as one. Along seams, edges are joined with the vertices
///    beside them. In a part whose edges have at most two triangles, triangles are turned so that neighbours agree. In
///    other parts, bodies touch each other or share walls. Such a part stays as it is in the file if its signed
///    boundary is empty and the winding number is not 0 in any of its chambers. Otherwise everything is inside that the
///    outside does not reach across an edge. If triangles cross so that this finds nothing, the parity of crossings
///    decides.
/// 3. Holes are filled with triangles of least area if these have at most a tenth of the part's area (kSmallHoles). A
///    part with larger holes remains a surface. With SolidRule::Filled, all holes are filled.
///
/// If a chamber of a part may still count as outside, the part is in the list as a Surface too. Vertices never move.
/// The triangles that fill a hole belong to the surface of the solid. Thread-safe. The result is shared between calls
/// with the same mesh while someone holds it.
std::shared_ptr<const SolidMesh> solidMeshOf(const std::shared_ptr<const Mesh>& mesh);

/// The share of a part's area up to which holes are filled. See docs/error_bounds.md.
constexpr double kSmallHoles = 0.1;
}  // namespace gpu_planning_scene::core
