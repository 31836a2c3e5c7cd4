#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <sstream>
#include <utility>

#include <sys/stat.h>
#include <tinyxml2.h>

#include "base/text/name_list.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/resources.h"
#include "model/files/package_path.h"

// Finds ROS packages as rospack does, without ROS.
namespace gpu_planning_scene::core
{
namespace
{
namespace fs = std::filesystem;

using FolderId = std::pair<dev_t, ino_t>;

/// The name in the folder's package.xml; empty if the folder has none.
std::string packageName(const fs::path& folder)
{
  std::error_code error;
  const fs::path manifest = folder / "package.xml";
  tinyxml2::XMLDocument document;
  if (!fs::exists(manifest, error) || document.LoadFile(manifest.c_str()) != tinyxml2::XML_SUCCESS)
    return "";
  const tinyxml2::XMLElement* root = document.FirstChildElement("package");
  const tinyxml2::XMLElement* name = root == nullptr ? nullptr : root->FirstChildElement("name");
  std::istringstream text(name == nullptr || name->GetText() == nullptr ? "" : name->GetText());
  std::string word;
  text >> word;
  return word;
}

/// The folders of a search path.
std::vector<fs::path> foldersOf(const std::string& path)
{
  std::vector<fs::path> folders;
  std::istringstream words(path);
  for (std::string word; std::getline(words, word, ':');)
    if (!word.empty())
      folders.emplace_back(word);
  return folders;
}

/// Adds the packages below a folder, unless their names are known already. The search does not go into packages, hidden
/// folders, and folders with CATKIN_IGNORE or rospack_nosubdirs. `seen`: folders that were searched, because symbolic
/// links can form a circle.
void crawl(const fs::path& folder, std::set<FolderId>& seen, std::map<std::string, std::string>& found)
{
  std::error_code error;
  struct stat status = {};
  if (stat(folder.c_str(), &status) != 0 || !seen.insert({status.st_dev, status.st_ino}).second ||
      fs::exists(folder / "CATKIN_IGNORE", error))
    return;
  if (const std::string name = packageName(folder); !name.empty())
  {
    found.emplace(name, folder.string());
    return;
  }
  if (fs::exists(folder / "rospack_nosubdirs", error))
    return;
  std::vector<fs::path> subfolders;
  fs::directory_iterator entries(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entries != fs::directory_iterator(); entries.increment(error))
    if (std::error_code unreadable; entries->path().filename().string()[0] != '.' && entries->is_directory(unreadable))
      subfolders.push_back(entries->path());
  std::sort(subfolders.begin(), subfolders.end());
  for (const fs::path& subfolder : subfolders)
    crawl(subfolder, seen, found);
}

/// The packages on a search path. Thread-safe.
class PackagePath
{
 public:
  explicit PackagePath(const std::string& path) : folders_(foldersOf(path)) {}

  /// The folder of a package; empty if there is none.
  std::string find(const std::string& package)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (const auto known = found_.find(package); known != found_.end())
      return known->second;
    // The usual place comes first, because a search through /usr/share takes long.
    for (; searched_ < folders_.size(); ++searched_)
    {
      const fs::path& folder = folders_[searched_];
      if (packageName(folder / package) == package)
        return found_.emplace(package, (folder / package).string()).first->second;
      crawl(folder, seen_, found_);
      if (const auto known = found_.find(package); known != found_.end())
      {
        ++searched_;
        return known->second;
      }
    }
    return "";
  }

 private:
  std::vector<fs::path> folders_;
  std::size_t searched_ = 0;  // folders of the path that were searched completely
  std::set<FolderId> seen_;
  std::map<std::string, std::string> found_;
  std::mutex mutex_;
};

/// The names of the given packages, so that the user notices a misspelt name.
std::string givenNames(const std::map<std::string, std::string>& folders)
{
  std::vector<std::string> names;
  for (const auto& [name, folder] : folders)
    names.push_back(name);
  return names.empty() ? "" : " (folders are given for: " + nameList(names) + ")";
}
}  // namespace

std::string packagePathVariable()
{
  const char* path = std::getenv("ROS_PACKAGE_PATH");
  return path != nullptr ? path : "/usr/share";
}

void requirePackageFolder(const std::string& folder, const std::string& package)
{
  if (std::error_code error; !fs::is_directory(folder, error))
    throw Error("the folder '" + folder + "' does not exist; check the folder given for package '" + package + "'");
}

PackageResolver packageResolver(std::map<std::string, std::string> folders, std::string remedy)
{
  return [folders = std::move(folders), remedy = std::move(remedy),
          path = std::make_shared<PackagePath>(packagePathVariable())](const std::string& package)
  {
    const auto given = folders.find(package);
    if (given != folders.end())
    {
      requirePackageFolder(given->second, package);
      return given->second;
    }
    std::string folder = path->find(package);
    if (!folder.empty())
      return folder;
    std::string how = remedy;
    if (const std::size_t name = how.find("NAME"); name != std::string::npos)
      how.replace(name, 4, package);
    throw Error("the folder of package '" + package + "' is not known" + givenNames(folders) +
                "; put the package on ROS_PACKAGE_PATH" + (how.empty() ? "" : ", or " + how));
  };
}
}  // namespace gpu_planning_scene::core
