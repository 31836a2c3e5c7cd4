#include "model/description/xacro_packages.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <tinyxml2.h>

#include "gpu_planning_scene/error.h"
#include "model/files/package_path.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace fs = std::filesystem;

std::string newTemporaryFolder()
{
  std::string name = (fs::temp_directory_path() / "gpu_planning_scene_xacro_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw Error("cannot make the folder '" + name + "' for xacro: " + std::generic_category().message(errno));
  return name;
}

void writeManifest(const fs::path& package, const std::string& name)
{
  tinyxml2::XMLPrinter manifest;
  manifest.OpenElement("package");
  manifest.OpenElement("name");
  manifest.PushText(name.c_str());
  manifest.CloseElement();
  manifest.CloseElement();
  std::ofstream(package / "package.xml") << manifest.CStr();
}

/// A folder of this name, with a manifest and links to the content of `folder`.
void makePackage(const fs::path& package, const std::string& name, const fs::path& folder)
{
  fs::create_directories(package);
  writeManifest(package, name);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().filename() != "package.xml")
      fs::create_symlink(entry.path(), package / entry.path().filename());
}
}  // namespace

XacroPackages::XacroPackages(const std::map<std::string, std::string>& folders)
{
  try
  {
    for (const auto& [name, folder] : folders)
    {
      if (name.empty() || name.front() == '.' || name.find_first_of("/:") != std::string::npos)
        continue;  // no name of a ROS package
      if (root_.empty())
        root_ = newTemporaryFolder();
      requirePackageFolder(folder, name);
      // The number keeps the path of one package from being the begin of another path.
      const fs::path package = fs::path(root_) / std::to_string(given_.size()) / name;
      makePackage(package, name, fs::absolute(folder));
      given_[package.string()] = fs::absolute(folder).lexically_normal().string();
      search_path_ += package.string() + ":";
    }
  }
  catch (const fs::filesystem_error& error)
  {
    std::error_code failure;
    fs::remove_all(root_, failure);
    throw Error(std::string("cannot prepare the given packages for xacro: ") + error.what());
  }
  catch (const Error&)
  {
    std::error_code failure;
    fs::remove_all(root_, failure);
    throw;
  }
  search_path_ += packagePathVariable();
}

XacroPackages::~XacroPackages()
{
  std::error_code failure;
  if (!root_.empty())
    fs::remove_all(root_, failure);
}

std::string XacroPackages::withGivenFolders(std::string text) const
{
  for (const auto& [package, folder] : given_)
    for (std::size_t at = text.find(package); at != std::string::npos; at = text.find(package, at + folder.size()))
      text.replace(at, package.size(), folder);
  return text;
}
}  // namespace gpu_planning_scene::core
