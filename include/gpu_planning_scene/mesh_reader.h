#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/resources.h"

namespace gpu_planning_scene::core
{
/// Limits for reading one mesh file, with the parameters of the node in brackets.
struct MeshLimits
{
  double seconds = 20.0;              ///< [~mesh/seconds] of wall time, and of processor time
  std::size_t memory = 2048UL << 20;  ///< [~mesh/memory] bytes of address space
  std::size_t file = 512UL << 20;     ///< [~mesh/file_size] bytes
  std::size_t triangles = 5000000;    ///< [~limits/triangles_of_mesh]
};

/// Returns a function that reads each file in a process of its own. `program`: the installed read_mesh. If that process
/// fails, the function throws an Error that names the file: "the reader crashed (signal 11)", "takes longer than 20 s",
/// "needs more than 2048 MiB". The function is thread-safe. childMeshReader throws Error unless limits.seconds is above
/// 0 and below 1e6.
ReadMesh childMeshReader(std::string program, const MeshLimits& limits);

/// Path of read_mesh. It is installed in the folder of the running program.
std::string meshReaderBesideThisProgram();

/// Folders from which mesh files may be read, in addition to packages and the base folder of relative paths.
struct AllowedRoots
{
  std::vector<std::string> roots;  ///< [~mesh/roots]; may be empty
};

/// Works like resolveUri, and refuses files outside the allowed folders. Symbolic links are followed first.
/// package://NAME/... must be in the folder of the package, file:// and absolute paths in one of the roots, relative
/// paths in `base_folder` or in one of the roots. Throws Error that names the URI and the allowed folders.
std::string resolveAllowed(const std::string& uri, const std::string& base_folder, const PackageResolver& packages,
                           const AllowedRoots& allowed);

/// Gets the URI of a mesh or octomap file, and returns the path of the file. An empty path means that the usual rules
/// apply.
using FindFile = std::function<std::string(const std::string& uri)>;

/// How mesh files are read, and from which folders. The default reads any file, in this process.
struct MeshAccess
{
  ReadMesh read;                      ///< empty: this process reads the file
  std::optional<AllowedRoots> roots;  ///< no value: any file
  FindFile find = {};                 ///< comes before all other rules; may be empty

  /// Calls `find`, then resolveAllowed if there are roots, else resolveUri.
  std::string resolve(const std::string& uri, const std::string& base_folder, const PackageResolver& packages) const;
};
}  // namespace gpu_planning_scene::core
