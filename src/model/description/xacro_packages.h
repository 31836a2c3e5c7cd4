#pragma once

#include <map>
#include <string>

namespace gpu_planning_scene::core
{
/// Makes xacro's $(find NAME) find given folders. xacro searches ROS_PACKAGE_PATH for a folder whose package.xml has
/// the name, but a given folder may have another name and no package.xml. So this class makes a temporary package of
/// each name, with links to the content of the given folder. The destructor removes these packages.
class XacroPackages
{
 public:
  /// `folders`: by the name of the package. Throws Error if a folder does not exist.
  explicit XacroPackages(const std::map<std::string, std::string>& folders);
  ~XacroPackages();
  XacroPackages(const XacroPackages&) = delete;
  XacroPackages& operator=(const XacroPackages&) = delete;

  /// The value of ROS_PACKAGE_PATH for xacro: the packages, then the variable's value in this process.
  const std::string& searchPath() const { return search_path_; }

  /// The text with the given folders in place of the temporary packages.
  std::string withGivenFolders(std::string text) const;

 private:
  std::string root_;  // the temporary folder; empty if there are no packages
  std::string search_path_;
  std::map<std::string, std::string> given_;  // by the path of the temporary package
};
}  // namespace gpu_planning_scene::core
