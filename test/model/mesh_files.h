#pragma once

#include <string>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// The contents of a mesh file that holds `mesh`.
std::string asciiStl(const Mesh& mesh);
std::string binaryStl(const Mesh& mesh, const std::string& header = "");
std::string objText(const Mesh& mesh);
std::string plyText(const Mesh& mesh);
/// `transforms`: XML of the node's transforms, which are applied to the mesh from the last to the first.
std::string daeText(const Mesh& mesh, const std::string& up_axis = "Z_UP", double unit = 1.0,
                    const std::string& transforms = "");
}  // namespace gpu_planning_scene::core
