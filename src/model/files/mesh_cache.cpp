#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <new>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/resources.h"
#include "model/coordinate_hash.h"

namespace gpu_planning_scene::core
{
namespace
{
// Gives equal positions (0 equals -0) the same index, because most formats repeat a vertex for each of its triangles.
// The hash table has open addressing, because files have millions of vertices.
class VertexWelder
{
 public:
  std::uint32_t index(const Eigen::Vector3d& position, std::vector<Eigen::Vector3d>& vertices)
  {
    if (2 * vertices.size() >= slots_.size())
      grow(vertices);
    const Eigen::Vector3d vertex = position.array() + 0.0;  // -0 becomes +0
    std::uint32_t& slot = slots_[find(vertex, vertices)];
    if (slot == kEmpty)
    {
      slot = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(vertex);
    }
    return slot;
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xffffffffu;

  // Finds the slot of the vertex, or the empty slot for it.
  std::size_t find(const Eigen::Vector3d& vertex, const std::vector<Eigen::Vector3d>& vertices) const
  {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hashOf(vertex) & mask;
    while (slots_[slot] != kEmpty && vertices[slots_[slot]] != vertex)
      slot = (slot + 1) & mask;
    return slot;
  }

  void grow(const std::vector<Eigen::Vector3d>& vertices)
  {
    slots_.assign(std::max<std::size_t>(1024, 4 * slots_.size()), kEmpty);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      slots_[find(vertices[i], vertices)] = static_cast<std::uint32_t>(i);
  }

  std::vector<std::uint32_t> slots_;
};

Eigen::Matrix<double, 3, 4> toEigen(const aiMatrix4x4& m)
{
  Eigen::Matrix<double, 3, 4> result;
  result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4;
  return result;
}

// Collects the triangles of a scene graph and applies the transforms of the nodes.
class SceneFlattener
{
 public:
  SceneFlattener(const aiScene& scene, const std::string& path, const Eigen::Vector3d& scale)
    : scene_(scene), scale_(scale), mesh_(std::make_shared<Mesh>())
  {
    mesh_->name = path;
    addNode(*scene.mRootNode, Eigen::Affine3d::Identity());
  }

  std::shared_ptr<const Mesh> mesh() const { return mesh_; }

 private:
  void addNode(const aiNode& node, const Eigen::Affine3d& parent)
  {
    Eigen::Affine3d pose;
    pose.matrix() << toEigen(node.mTransformation), 0.0, 0.0, 0.0, 1.0;
    pose = parent * pose;
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
      addMesh(*scene_.mMeshes[node.mMeshes[i]], Eigen::Scaling(scale_) * pose);
    for (unsigned i = 0; i < node.mNumChildren; ++i)
      addNode(*node.mChildren[i], pose);
  }

  void addMesh(const aiMesh& part, const Eigen::Affine3d& pose)
  {
    const bool mirrored = pose.linear().determinant() < 0.0;  // a mirrored triangle would be inside out
    for (unsigned i = 0; i < part.mNumFaces; ++i)
    {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices != 3)
        continue;  // points and lines have no surface
      std::array<std::uint32_t, 3> triangle;
      for (int corner = 0; corner < 3; ++corner)
        triangle[corner] = welder_.index(position(part, face.mIndices[corner], pose), mesh_->vertices);
      if (mirrored)
        std::swap(triangle[1], triangle[2]);
      mesh_->triangles.push_back(triangle);
    }
  }

  Eigen::Vector3d position(const aiMesh& part, unsigned index, const Eigen::Affine3d& pose) const
  {
    if (index >= part.mNumVertices)
    {
      throw Error("mesh file '" + mesh_->name + "': triangle " + std::to_string(mesh_->triangles.size()) +
                  " names a vertex that the file does not have");
    }
    const aiVector3D& vertex = part.mVertices[index];
    Eigen::Vector3d placed = pose * Eigen::Vector3d(vertex.x, vertex.y, vertex.z);
    if (!placed.allFinite())
    {
      throw Error("mesh file '" + mesh_->name + "': a vertex of triangle " + std::to_string(mesh_->triangles.size()) +
                  " is not finite");
    }
    return placed;
  }

  const aiScene& scene_;
  const Eigen::Vector3d scale_;
  VertexWelder welder_;
  std::shared_ptr<Mesh> mesh_;
};

std::string lowerCaseExtension(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// Assimp turns exceptions into text. Out of memory is not a fault of the file, so it is thrown again.
void throwIfOutOfMemory(const std::string& error)
{
  if (error == std::bad_alloc().what() || error == std::bad_array_new_length().what())
    throw std::bad_alloc();
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

std::shared_ptr<const Mesh> readMesh(const std::string& path, const Eigen::Vector3d& scale)
{
  const std::string extension = lowerCaseExtension(path);
  if (extension != ".stl" && extension != ".dae" && extension != ".obj" && extension != ".ply")
    throw Error("mesh file '" + path + "': only .stl, .dae, .obj and .ply files can be read");
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable))
    throw Error("mesh file '" + path + "' does not exist" + missingFolder(path));
  if (!scale.allFinite() || scale.prod() == 0.0)
    throw Error("mesh file '" + path + "': its scale has a component that is zero or not finite");

  Assimp::Importer importer;
  // For a Collada file, Assimp puts the scale of the file's unit and a rotation from its up-axis to y on the root node.
  // ROS frames have z up, so RViz and geometric_shapes (MoveIt) ignore the up-axis, while RViz applies the unit. So the
  // rotation is switched off and the scale is kept.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Assimp would invent triangles to show the nodes of a file without a mesh.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // Assimp must not remove or merge anything: degenerate triangles stay, and VertexWelder merges vertices much faster.
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr)
  {
    throwIfOutOfMemory(importer.GetErrorString());
    throw Error("mesh file '" + path + "' cannot be read: " + importer.GetErrorString());
  }
  std::shared_ptr<const Mesh> mesh = SceneFlattener(*scene, path, scale).mesh();
  if (mesh->triangles.empty())
    throw Error("mesh file '" + path + "' has no triangles");
  return mesh;
}
}  // namespace

MeshCache::MeshCache(ReadMesh read) : read_(read ? std::move(read) : readMesh) {}

std::shared_ptr<const Mesh> MeshCache::load(const std::string& path, const Eigen::Vector3d& scale)
{
  const auto key = std::pair(path, std::array<double, 3>{scale.x(), scale.y(), scale.z()});
  const auto found = meshes_.find(key);
  if (found != meshes_.end())
    return found->second;
  return meshes_.emplace(key, read_(path, scale)).first->second;
}
}  // namespace gpu_planning_scene::core
