#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Geometry>

#include "literature/shared_tree.h"
#include "literature/solids.h"

/// Meshes of hard cases, of about a metre.
namespace gpu_planning_scene::core::literature
{

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

/// A needle of a metre with a thickness of a tenth of a millimetre. It lies along kNeedleAxis, at an angle to all axes,
/// so that its bounding box is thousands of times as wide.
MeshPtr needle();
extern const Eigen::Vector3d kNeedleAxis;

/// An upright plate: a metre along kPlateAxis, a tenth of a metre along z, a tenth of a millimetre thick.
MeshPtr plate();
extern const Eigen::Vector3d kPlateAxis;

/// Tetrahedra with edges of kGrainSize, scattered in a cube of a metre. `turn`: of each grain about its centre. The
/// same seed gives the same places.
MeshPtr grains(std::uint64_t seed, const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity());
constexpr double kGrainSize = 1e-4;  // metres

/// Boxes of a tenth of a metre, as one mesh.
MeshPtr pile(std::uint64_t seed);
}  // namespace gpu_planning_scene::core::literature
