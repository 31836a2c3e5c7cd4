#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu_planning_scene/resources.h"

namespace gpu_planning_scene::core
{
/// Reads a mesh file in this process, and scales it per axis; a negative scale mirrors it. The extension of the file
/// names its format: .stl, .obj, .ply or .dae. Coordinates keep the precision of double. Polygons are cut into
/// triangles as they are drawn, also concave ones. Throws Error if the file is missing or cannot be read, if it has no
/// triangles or a vertex that is not finite or farther than 1000 km away, or if a scale is 0 or not finite. The message
/// is one line that names the file. Thread-safe.
std::shared_ptr<const Mesh> readMeshFile(const std::string& path, const Eigen::Vector3d& scale);

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

/// Path of read_mesh, which is installed in the folder gpu_planning_scene beside this library. Throws Error if it is
/// not there.
std::string meshReaderProgram();

/// A function that reads each file in a process of its own, without limits. It is the default of MeshCache and
/// MeshAccess: a file that crashes its reader ends neither a tool nor a Python session.
ReadMesh defaultMeshReader();

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

/// How mesh files are read, and from which folders. The default reads any file.
struct MeshAccess
{
  ReadMesh read;                      ///< empty: defaultMeshReader(); readMeshFile: this process reads the files
  std::optional<AllowedRoots> roots;  ///< no value: any file
  FindFile find = {};                 ///< comes before all other rules; may be empty

  /// Calls `find`, then resolveAllowed if there are roots, else resolveUri.
  std::string resolve(const std::string& uri, const std::string& base_folder, const PackageResolver& packages) const;
};
}  // namespace gpu_planning_scene::core
