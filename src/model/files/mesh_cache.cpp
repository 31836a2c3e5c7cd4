#include "gpu_planning_scene/mesh_reader.h"
#include "gpu_planning_scene/resources.h"

namespace gpu_planning_scene::core
{
MeshCache::MeshCache(ReadMesh read) : read_(read ? std::move(read) : defaultMeshReader()) {}

std::shared_ptr<const Mesh> MeshCache::load(const std::string& path, const Eigen::Vector3d& scale)
{
  const auto key = std::pair(path, std::array<double, 3>{scale.x(), scale.y(), scale.z()});
  const auto found = meshes_.find(key);
  if (found != meshes_.end())
    return found->second;
  return meshes_.emplace(key, read_(path, scale)).first->second;
}
}  // namespace gpu_planning_scene::core
