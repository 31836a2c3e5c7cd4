#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Geometry>

#include "literature/solids.h"

/// Meshes of hard cases, of about a metre.
namespace gpu_planning_scene::core::literature
{
using MeshPtr = std::shared_ptr<const Mesh>;

/// See madeModel.
MeshPtr modelMesh(const char* model, std::size_t triangles = 400);
/// The vertices are scaled first.
MeshPtr moved(const MeshPtr& mesh, const Eigen::Isometry3d& pose, double scale = 1.0);
MeshPtr scaled(const MeshPtr& mesh, double scale);

enum class Damage
{
  Removed,
  Flipped,
  Doubled
};
/// Every tenth triangle, chosen at random, is damaged.
MeshPtr damaged(const MeshPtr& mesh, Damage damage, std::uint64_t seed);

/// Triangles that point away from a common centre, half a metre long and a twentieth of a millimetre wide.
MeshPtr needles(std::uint64_t seed);

/// Boxes of a tenth of a metre, as one mesh.
MeshPtr pile(std::uint64_t seed);
}  // namespace gpu_planning_scene::core::literature
