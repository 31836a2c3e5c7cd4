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
/// Maps the name of a ROS package to its folder. It returns an empty string, or throws Error with the remedy, if the
/// package is unknown.
using PackageResolver = std::function<std::string(const std::string& package)>;

/// A resolver for NAME -> DIR pairs and, after them, for the packages below the folders of ROS_PACKAGE_PATH. It needs
/// no ROS, but finds packages as ROS does: a package is a folder with a package.xml that has the name of the package.
/// The first such folder on the path counts. The path is searched when a package is first needed. The resolver throws
/// Error for a given folder that does not exist, and for an unknown package. `remedy` becomes the end of the message
/// about an unknown package. It tells the user how to name the folder of a package; NAME in it is replaced by the name
/// of the package. With an empty remedy, the message names only ROS_PACKAGE_PATH.
PackageResolver packageResolver(std::map<std::string, std::string> folders,
                                std::string remedy = "give packageResolver the folder of NAME");

/// Turns a mesh URI into a file path. `uri`: package://NAME/PATH, file:///PATH, an absolute path, or a path relative to
/// `base_folder`. `base_folder`: the folder of the URDF; if it is empty, relative paths are refused. Escapes such as
/// %20 are decoded in URIs. package:///NAME/PATH is read as package://NAME/PATH. Throws Error that names the URI. The
/// function does not check that the file exists.
std::string resolveUri(const std::string& uri, const std::string& base_folder, const PackageResolver& packages);

/// Reads a mesh file and scales it per axis. Throws Error.
using ReadMesh = std::function<std::shared_ptr<const Mesh>(const std::string& path, const Eigen::Vector3d& scale)>;

/// Loads and keeps meshes from STL, DAE, OBJ and PLY files. It reads a file once per scale. As in RViz, the unit of a
/// DAE file is applied, but not its up-axis. Not thread-safe.
class MeshCache
{
 public:
  /// `read`: reads the files; empty: defaultMeshReader().
  explicit MeshCache(ReadMesh read = {});

  /// The mesh of a file, scaled per axis; a negative scale mirrors it. Throws Error if the file is missing or cannot be
  /// read, if it has no triangles or a vertex that is not finite, or if a scale is 0 or not finite.
  std::shared_ptr<const Mesh> load(const std::string& path, const Eigen::Vector3d& scale);

 private:
  ReadMesh read_;
  std::map<std::pair<std::string, std::array<double, 3>>, std::shared_ptr<const Mesh>> meshes_;
};
}  // namespace gpu_planning_scene::core
