#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Faults that the mesh files of real robots have.
enum class MeshDamage
{
  Flipped,       ///< some triangles have the wrong direction
  Doubled,       ///< some triangles are there twice
  FrontAndBack,  ///< all triangles are there twice, once in each direction
  Split,         ///< some edges are cut on one side only
  Shifted,       ///< some triangles have corners of their own, up to 1e-7 of the mesh's size away
  Cracked,       ///< some triangles have corners of their own, up to 4e-4 of the mesh's size away
  Deleted,       ///< some triangles are missing
  Shuffled       ///< none: triangles, corners and vertices are in another order, and no vertex is shared
};
const std::vector<MeshDamage>& allMeshDamages();
std::string nameOf(MeshDamage damage);

/// A copy of a mesh in which about `share` (0 to 1) of the triangles are damaged, at least one.
std::shared_ptr<const Mesh> damaged(const Mesh& mesh, MeshDamage damage, double share, std::mt19937_64& generator);
}  // namespace gpu_planning_scene::core
