#pragma once

#include <array>
#include <memory>
#include <vector>

#include "gpu_planning_scene/shapes.h"
#include "stability/random.h"

namespace gpu_planning_scene::core::stability
{
using MeshPtr = std::shared_ptr<const Mesh>;

MeshPtr makeMesh(std::vector<Eigen::Vector3d> vertices, std::vector<std::array<std::uint32_t, 3>> triangles);
MeshPtr triangleMesh(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Edges of about a metre.
MeshPtr randomTriangle(Random& random);
/// One edge of about a metre. The opposite corner is `aspect` metres from this edge.
MeshPtr sliver(Random& random, double aspect);
/// A closed mesh of four triangles.
MeshPtr randomTetrahedron(Random& random);
MeshPtr boxMesh(const Eigen::Vector3d& size);
/// 0.2 to 1 m along each axis.
Eigen::Vector3d randomSize(Random& random);
/// A closed ball with bumps and a radius of 0.4 to 0.5 m; not convex.
MeshPtr bumpyBall(Random& random, int rings);

/// A tetrahedron, a box or a ball.
MeshPtr randomClosed(Random& random);
/// A box of 1 m with a cavity in the shape of a box.
MeshPtr hollowBox(double cavity);
/// A ball with a crack, a flipped triangle, a duplicate triangle, or a self-intersection.
MeshPtr damagedBall(Random& random);

MeshPtr inverted(const Mesh& mesh);
/// Negates x and keeps the orders of the corners, so the mesh is inside out.
MeshPtr mirrored(const Mesh& mesh);
MeshPtr scaled(const Mesh& mesh, double factor);
MeshPtr moved(const Mesh& mesh, const Eigen::Isometry3d& pose);
/// One mesh with the triangles of both.
MeshPtr joined(const Mesh& first, const Mesh& second);
MeshPtr without(const Mesh& mesh, std::size_t triangle);
/// Reverses the order of the triangles, and permutes the corners of each triangle. `corner_order`: 0 to 5.
MeshPtr reordered(const Mesh& mesh, int corner_order);
}  // namespace gpu_planning_scene::core::stability
