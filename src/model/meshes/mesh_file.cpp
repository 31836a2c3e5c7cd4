

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>

#include "base/text/one_line.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/mesh_reader.h"
#include "model/meshes/mesh_formats.h"

namespace gpu_planning_scene::core
{
namespace
{
using Read = void (*)(std::string_view content, MeshBuilder& mesh);

const std::map<std::string, Read> kFormats = {
    {".stl", readStl}, {".obj", readObj}, {".ply", readPly}, {".dae", readCollada}};

std::string lowerCaseExtension(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// Names the first folder on a path that does not exist, often the folder of a package. Empty if only the file is
/// missing.
std::string missingFolder(const std::string& path)
{
  std::error_code unreadable;
  std::filesystem::path missing;
  for (std::filesystem::path folder = std::filesystem::path(path).parent_path();
       !folder.empty() && !std::filesystem::exists(folder, unreadable); folder = folder.parent_path())
    missing = folder;
  return missing.empty() ? "" : "; there is no folder '" + missing.string() + "'";
}

std::string contentOf(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  std::string content(static_cast<std::size_t>(std::max<std::streamoff>(0, size)), '\0');
  file.seekg(0);
  if (!file.read(content.data(), static_cast<std::streamsize>(content.size())))
    throw Error("the system does not let this program read it");
  return content;
}
}  // namespace

std::shared_ptr<const Mesh> readMeshFile(const std::string& path, const Eigen::Vector3d& scale)
{
  const std::string file = "mesh file '" + path + "'";
  const auto format = kFormats.find(lowerCaseExtension(path));
  if (format == kFormats.end())
    throw Error(file + ": only .stl, .dae, .obj and .ply files can be read");
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable))
    throw Error(file + " does not exist" + missingFolder(path));
  if (!scale.allFinite() || scale.prod() == 0.0)
    throw Error(file + ": its scale has a component that is zero or not finite");
  try
  {
    MeshBuilder mesh(path, scale);
    format->second(contentOf(path), mesh);
    return mesh.finish();
  }
  catch (const Error& error)
  {
    throw Error(file + " cannot be read: " + onOneLine(error.what()));
  }
}
}  // namespace gpu_planning_scene::core
