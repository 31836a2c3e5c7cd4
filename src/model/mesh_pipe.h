#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// A mesh as the bytes that read_mesh sends: the counts of vertices and triangles (64 bits each), the vertices (3
/// doubles each), the triangles (3 indices of 32 bits each), as the machine has them: both ends run on it.
std::string meshBytes(const Mesh& mesh);

/// How many bytes a mesh of at most that many triangles can have.
std::size_t mostMeshBytes(std::size_t triangles);

/// The mesh in those bytes, which are not trusted: throws Error that names `path`.
std::shared_ptr<const Mesh> meshFromBytes(const std::string& bytes, const std::string& path,
                                          std::size_t most_triangles);
}  // namespace gpu_planning_scene::core
