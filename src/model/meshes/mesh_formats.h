#pragma once

#include <string>
#include <string_view>

#include "model/meshes/mesh_builder.h"

namespace gpu_planning_scene::core
{
// Each function reads the content of a file and adds its polygons to `mesh`. It throws Error, with the place in the
// file, for content that is malformed or that it does not know, unless that content can have no surface. Coordinates
// are read as doubles.

/// Binary and ASCII STL.
void readStl(std::string_view content, MeshBuilder& mesh);

/// Wavefront OBJ. Points, lines, normals, texture coordinates, groups and materials are left out, because they have no
/// surface. Curved surfaces are refused.
void readObj(std::string_view content, MeshBuilder& mesh);

/// ASCII and binary PLY, with elements `face` and `tristrips`. Other elements are skipped.
void readPly(std::string_view content, MeshBuilder& mesh);

/// COLLADA 1.4 and 1.5 (.dae): the meshes of the file's scene at the poses of their nodes, in metres. As in RViz, the
/// unit of the file is applied, but not its up-axis, because ROS frames have z up.
void readCollada(std::string_view content, MeshBuilder& mesh);
}  // namespace gpu_planning_scene::core
