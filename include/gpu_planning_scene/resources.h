#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <Eigen/Core>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// Maps a ROS package name to its folder; returns an empty string where it does not know the package.
/// The libraries know no ROS: the node passes ros::package::getPath, the tools what --package said.
using PackageResolver = std::function<std::string(const std::string& package)>;

/// A resolver for NAME -> DIR pairs.
PackageResolver packageResolver(std::map<std::string, std::string> folders);

/// Turns a mesh URI into a file path: package://NAME/PATH, file:///PATH, an absolute path, or a path relative to
/// `base_folder` (the folder of the URDF; may be empty, then relative paths are an error). %20-style escapes are
/// decoded in URIs. Throws Error that names the URI; does not look whether the file is there.
std::string resolveUri(const std::string& uri, const std::string& base_folder, const PackageResolver& packages);

/// Reads a mesh file, scaled per axis; throws Error.
using ReadMesh = std::function<std::shared_ptr<const Mesh>(const std::string& path, const Eigen::Vector3d& scale)>;

/// Loads meshes from STL, DAE, OBJ and PLY files and keeps what it loaded: a file with the same scale is read once.
/// The unit of a DAE is applied and its up-axis is not, as in RViz. Not thread-safe.
class MeshCache
{
 public:
  /// `read`: who reads the files; empty: this process.
  explicit MeshCache(ReadMesh read = {});

  /// The mesh of a file, scaled per axis; negative scales mirror. Throws Error: missing or unreadable file, no
  /// triangles, non-finite vertices.
  std::shared_ptr<const Mesh> load(const std::string& path, const Eigen::Vector3d& scale);

 private:
  ReadMesh read_;
  std::map<std::pair<std::string, std::array<double, 3>>, std::shared_ptr<const Mesh>> meshes_;
};
}  // namespace gpu_planning_scene::core
