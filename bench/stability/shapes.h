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
/// One edge of about a metre, the corner opposite `aspect` metres from it.
MeshPtr sliver(Random& random, double aspect);
/// A closed mesh of four triangles.
MeshPtr randomTetrahedron(Random& random);
MeshPtr boxMesh(const Eigen::Vector3d& size);
/// 0.2 to 1 m along each axis.
Eigen::Vector3d randomSize(Random& random);
/// A closed ball of radius 0.5, with bumps: not convex.
MeshPtr bumpyBall(Random& random, int rings);

/// A tetrahedron, a box or a ball.
MeshPtr randomClosed(Random& random);
/// A box of 1 m with a cavity in the shape of a box.
MeshPtr hollowBox(double cavity);
/// A ball with a crack, a flipped triangle, a duplicate one, or passing through itself.
MeshPtr damagedBall(Random& random);

MeshPtr inverted(const Mesh& mesh);
/// x is negated, the triangles stay: inside out.
MeshPtr mirrored(const Mesh& mesh);
MeshPtr scaled(const Mesh& mesh, double factor);
MeshPtr moved(const Mesh& mesh, const Eigen::Isometry3d& pose);
/// One mesh of both.
MeshPtr joined(const Mesh& first, const Mesh& second);
MeshPtr without(const Mesh& mesh, std::size_t triangle);
/// The triangles in another order, each with its corners in another order.
MeshPtr reordered(const Mesh& mesh, int corner_order);
}  // namespace gpu_planning_scene::core::stability
