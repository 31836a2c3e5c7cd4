#pragma once

#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/solids.h"

namespace gpu_planning_scene::core
{
/// A part of a mesh that was not closed as it was given.
struct BodyPart
{
  int body;          ///< body index of the planning scene
  std::string mesh;  ///< Mesh::name
  MeshPart part;
};

/// The parts of the meshes of all bodies that were mended or filled, or remained surfaces; by body. Takes some
/// milliseconds for a mesh of 10,000 triangles, unless a checker has the scene. Thread-safe.
std::vector<BodyPart> openParts(const PlanningScene& scene);

/// One line for each mesh with filled holes, and one for each mesh with parts that remained surfaces: body, file,
/// number and size of the holes, and what the user can do.
std::vector<std::string> describeOpenParts(const PlanningScene& scene);
}  // namespace gpu_planning_scene::core
