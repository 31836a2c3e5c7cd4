#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/resources.h"

namespace gpu_planning_scene::core
{
/// What one mesh file may cost. The node's parameters in brackets.
struct MeshLimits
{
  double seconds = 20.0;              ///< [~mesh/seconds] of wall time, and of processor time
  std::size_t memory = 2048UL << 20;  ///< [~mesh/memory] bytes of address space
  std::size_t file = 512UL << 20;     ///< [~mesh/file_size] bytes
  std::size_t triangles = 5000000;    ///< [~limits/triangles_of_mesh]
};

/// Reads each file in a process of its own: `program` is the installed read_mesh. Whatever becomes of that process, the
/// caller gets a mesh or an Error that names the file: "the reader crashed (signal 11)", "takes longer than 20 s",
/// "needs more than 2048 MiB". Thread-safe.
ReadMesh childMeshReader(std::string program, const MeshLimits& limits);

/// read_mesh in the folder of the program that runs, where they are installed together.
std::string meshReaderBesideThisProgram();

/// The folders that mesh files may be read from besides packages.
struct AllowedRoots
{
  std::vector<std::string> roots;  ///< [~mesh/roots]; none: packages alone
};

/// resolveUri, and refuses what lies elsewhere, links followed: package://NAME/... must be in the package's folder,
/// file:// and absolute paths in one of the roots, relative paths in `base_folder` or a root. Throws Error that names
/// the URI and what is allowed.
std::string resolveAllowed(const std::string& uri, const std::string& base_folder, const PackageResolver& packages,
                           const AllowedRoots& allowed);

/// Who reads mesh files, and from where. As it stands: this process, from anywhere.
struct MeshAccess
{
  ReadMesh read;                      ///< empty: in this process
  std::optional<AllowedRoots> roots;  ///< no value: any file

  /// resolveAllowed, or resolveUri where there are no roots.
  std::string resolve(const std::string& uri, const std::string& base_folder, const PackageResolver& packages) const;
};
}  // namespace gpu_planning_scene::core
