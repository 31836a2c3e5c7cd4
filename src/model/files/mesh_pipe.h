#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Serialises a mesh for the pipe from read_mesh: number of vertices and of triangles (64 bits each), vertices (3
/// doubles each), triangles (3 indices of 32 bits each). The byte order is the machine's, because both ends run on one
/// machine.
std::string meshBytes(const Mesh& mesh);

/// Largest number of bytes of a mesh with at most this many triangles.
std::size_t maxMeshBytes(std::size_t triangles);

/// Reads a mesh from these bytes, which are not trusted. Throws Error that names `path`.
std::shared_ptr<const Mesh> meshFromBytes(const std::string& bytes, const std::string& path, std::size_t max_triangles);
}  // namespace gpu_planning_scene::core
