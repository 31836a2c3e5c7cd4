#include <filesystem>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/mesh_reader.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace fs = std::filesystem;

const std::string kPackage = "package://";

/// The path with all symbolic links followed, as far as it exists.
fs::path followed(const fs::path& path, const std::string& uri)
{
  std::error_code error;
  fs::path result = fs::weakly_canonical(fs::absolute(path), error);
  if (error)
    throw Error("mesh URI '" + uri + "': " + path.string() + ": " + error.message());
  return result;
}

/// True if a path is below a folder. It compares whole names, so that /meshes_2 is not in /meshes.
bool liesIn(const fs::path& path, const fs::path& folder)
{
  auto part = path.begin();
  for (const fs::path& expected : folder)
  {
    if (expected.empty())
      continue;  // a trailing slash makes an empty last name
    if (part == path.end() || *part != expected)
      return false;
    ++part;
  }
  return part != path.end();
}

std::string listOf(const std::vector<std::string>& roots)
{
  std::string text;
  for (const std::string& root : roots)
    text += (text.empty() ? "" : ", ") + root;
  return text.empty() ? "there are none" : text;
}

/// The folder of the package that a URI names. resolveUri has checked the URI already.
std::string packageFolder(const std::string& uri, const PackageResolver& packages)
{
  const std::size_t name = uri.find_first_not_of('/', kPackage.size());
  const std::string probe = resolveUri(uri.substr(0, uri.find('/', name)) + "/x", "", packages);
  return fs::path(probe).parent_path().string();
}
}  // namespace

std::string resolveAllowed(const std::string& uri, const std::string& base_folder, const PackageResolver& packages,
                           const AllowedRoots& allowed)
{
  const fs::path path = followed(resolveUri(uri, base_folder, packages), uri);
  if (uri.compare(0, kPackage.size(), kPackage) == 0)
  {
    if (!liesIn(path, followed(packageFolder(uri, packages), uri)))
      throw Error("mesh URI '" + uri + "' leaves its package: it is a link to " + path.string());
    return path.string();
  }
  const bool relative = uri[0] != '/' && uri.find("://") == std::string::npos;
  if (relative && liesIn(path, followed(base_folder, uri)))
    return path.string();
  for (const std::string& root : allowed.roots)
    if (liesIn(path, followed(root, uri)))
      return path.string();
  throw Error("mesh URI '" + uri + "': " + path.string() + " is in none of the folders that meshes may be read from (" +
              listOf(allowed.roots) + "); use package://, or allow its folder (~mesh/roots)");
}

std::string MeshAccess::resolve(const std::string& uri, const std::string& base_folder,
                                const PackageResolver& packages) const
{
  if (find)
    if (std::string path = find(uri); !path.empty())
      return path;
  return roots ? resolveAllowed(uri, base_folder, packages, *roots) : resolveUri(uri, base_folder, packages);
}
}  // namespace gpu_planning_scene::core
