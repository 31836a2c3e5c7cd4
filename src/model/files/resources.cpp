#include "gpu_planning_scene/resources.h"

#include <cctype>
#include <filesystem>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace fs = std::filesystem;

bool startsWith(const std::string& text, const std::string& prefix)
{
  return text.compare(0, prefix.size(), prefix) == 0;
}

// A percent sign without two hexadecimal digits after it is kept, as in libcurl, which ROS uses to read URIs.
std::string decodePercents(const std::string& text, const std::string& uri)
{
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    if (text[i] == '%' && i + 2 < text.size() && std::isxdigit(static_cast<unsigned char>(text[i + 1])) &&
        std::isxdigit(static_cast<unsigned char>(text[i + 2])))
    {
      decoded += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    }
    else
    {
      decoded += text[i];
    }
  }
  if (decoded.find('\0') != std::string::npos)
    throw Error("mesh URI '" + uri + "' contains a zero byte");
  return decoded;
}

std::string folderOf(const std::string& package, const std::string& uri, const PackageResolver& packages)
{
  std::string folder;
  try
  {
    folder = packages ? packages(package) : "";
  }
  catch (const Error& error)
  {
    throw Error("mesh URI '" + uri + "': " + error.what());
  }
  if (folder.empty())
    throw Error("mesh URI '" + uri + "': the folder of package '" + package + "' is not known");
  return folder;
}

/// The package name ends at the first slash of the URI, as in ROS. So a decoded name must not contain a slash. Some
/// published URDFs have package:///NAME/PATH. No package has an empty name, so the further slashes are passed over.
std::string resolvePackageUri(const std::string& uri, const PackageResolver& packages)
{
  const std::size_t name = uri.find_first_not_of('/', std::string("package://").size());
  const std::string rest = name == std::string::npos ? "" : uri.substr(name);
  const std::size_t slash = rest.find('/');
  const std::string package = decodePercents(rest.substr(0, slash), uri);
  const fs::path inside = slash == std::string::npos
                              ? fs::path()
                              : fs::path(decodePercents(rest.substr(slash + 1), uri)).lexically_normal();
  if (package.empty() || inside.empty() || inside == ".")
    throw Error("mesh URI '" + uri + "' is not of the form package://NAME/PATH");
  if (package == "." || package == ".." || package.find('/') != std::string::npos || inside.is_absolute() ||
      *inside.begin() == "..")
    throw Error("mesh URI '" + uri + "' leaves its package");
  return (fs::path(folderOf(package, uri, packages)) / inside).string();
}

std::string resolveFileUri(const std::string& uri)
{
  std::string path = uri.substr(std::string("file://").size());
  if (startsWith(path, "localhost/"))
    path.erase(0, std::string("localhost").size());
  path = decodePercents(path, uri);
  if (path.empty() || path[0] != '/')
    throw Error("mesh URI '" + uri + "' names no absolute path; write file:///PATH");
  return path;
}
}  // namespace

std::string resolveUri(const std::string& uri, const std::string& base_folder, const PackageResolver& packages)
{
  if (uri.empty())
    throw Error("a mesh has an empty file name");
  if (startsWith(uri, "package://"))
    return resolvePackageUri(uri, packages);
  if (startsWith(uri, "file://"))
    return resolveFileUri(uri);
  if (uri.find("://") != std::string::npos)
    throw Error("mesh URI '" + uri + "': only package://, file:// and plain paths can be read");
  if (uri[0] == '/')
    return uri;
  if (base_folder.empty())
    throw Error("mesh path '" + uri +
                "' is relative, and the folder of the URDF is not known; give it (urdf_folder:= of the launch file), "
                "or write package:// or an absolute path");
  return (fs::path(base_folder) / uri).string();
}
}  // namespace gpu_planning_scene::core
