// Coordinates of mesh files keep the precision of double, and all files at hand are read as Assimp reads them.

#include <filesystem>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <assimp/Importer.hpp>

#include "gpu_planning_scene/mesh_reader.h"
#include "model/mesh_files.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
using ReadTriangles = std::vector<std::array<Eigen::Vector3d, 3>>;

std::shared_ptr<const Mesh> read(const std::string& path)
{
  return readMeshFile(path, Eigen::Vector3d::Ones());
}

void addTriangles(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& parent, ReadTriangles& triangles)
{
  const aiMatrix4x4& m = node.mTransformation;
  Eigen::Affine3d pose;
  pose.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0.0, 0.0, 0.0, 1.0;
  pose = parent * pose;
  for (unsigned i = 0; i < node.mNumMeshes; ++i)
  {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[i]];
    for (unsigned k = 0; k < part.mNumFaces; ++k)
    {
      if (part.mFaces[k].mNumIndices != 3)
        continue;
      std::array<Eigen::Vector3d, 3>& triangle = triangles.emplace_back();
      for (unsigned corner = 0; corner < 3; ++corner)
      {
        const aiVector3D& vertex = part.mVertices[part.mFaces[k].mIndices[corner]];
        triangle[corner] = pose * Eigen::Vector3d(vertex.x, vertex.y, vertex.z);
      }
      if (pose.linear().determinant() < 0.0)
        std::swap(triangle[1], triangle[2]);
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    addTriangles(scene, *node.mChildren[i], pose, triangles);
}

/// The triangles that Assimp reads, in the order of the file.
ReadTriangles assimpTriangles(const std::string& path)
{
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  ReadTriangles triangles;
  if (scene != nullptr && scene->mRootNode != nullptr)
    addTriangles(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), triangles);
  return triangles;
}

/// The largest distance of two corners that belong together. The first corner may be another one.
double distance(const std::array<Eigen::Vector3d, 3>& a, const std::array<Eigen::Vector3d, 3>& b)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t shift = 0; shift < 3; ++shift)
  {
    double largest = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      largest = std::max(largest, (a[i] - b[(i + shift) % 3]).norm());
    smallest = std::min(smallest, largest);
  }
  return smallest;
}

TEST(MeshPrecision, TheFilesAtHandAreReadAsAssimpReadsThem)
{
  namespace fs = std::filesystem;
  std::size_t files = 0;
  for (const fs::path& folder : {fs::path(GPS_DART_DATA_DIR) / "urdf", fs::path(GPS_DART_DATA_DIR) / "obj",
                                 fs::path(GPS_SHARED_DIR) / "robots", fs::path(GPS_SHARED_DIR) / "moveit/resources"})
  {
    if (!fs::exists(folder))
      continue;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
    {
      const std::string extension = entry.path().extension().string();
      const std::string path = entry.path().string();
      const bool is_mesh = std::set<std::string>{".stl", ".STL", ".obj", ".ply", ".dae"}.count(extension) != 0;
      if (!is_mesh || entry.file_size() > 150000 || path.find("invalid") != std::string::npos)
        continue;
      const ReadTriangles theirs = assimpTriangles(path);
      const auto mesh = read(path);
      ++files;
      ASSERT_EQ(mesh->triangles.size(), theirs.size()) << path;
      double size = 0.0;
      for (const Eigen::Vector3d& vertex : mesh->vertices)
        size = std::max(size, vertex.norm());
      for (std::size_t i = 0; i < theirs.size(); ++i)
      {
        const auto& [a, b, c] = mesh->triangles[i];
        ASSERT_LT(distance({mesh->vertices[a], mesh->vertices[b], mesh->vertices[c]}, theirs[i]), 1e-5 * size)
            << path << ": triangle " << i;
      }
    }
  }
  if (files == 0)
    GTEST_SKIP() << "there are no meshes in " << GPS_DART_DATA_DIR << " and " << GPS_SHARED_DIR;
  EXPECT_GT(files, 20u);
}

/// A triangle with this text as the x of its first vertex, in each text format.
std::vector<std::string> filesWith(const TemporaryFolder& folder, const std::string& x)
{
  std::string dae = daeText({"", {{7.5, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  dae.replace(dae.find("7.5"), 3, x);
  std::string ply = plyText({"", {{7.5, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  ply.replace(ply.find("7.5"), 3, x);
  return {folder.write("a.obj", "v " + x + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
          folder.write("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex " + x +
                                    " 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"),
          folder.write("a.ply", ply), folder.write("a.dae", dae)};
}

TEST(MeshPrecision, NumbersInTextsAreReadAsDoubles)
{
  const TemporaryFolder folder;
  const std::vector<std::pair<std::string, double>> numbers = {
      {"0.99999998", 0.99999998},
      {"0.1000000000000000055511151231257827", 0.1},
      {"100000.00000000000000000000000000000000000001", 100000.0},
      {"00000000000000000000000000000000000002.5", 2.5},
      {"-3.5e-5", -3.5e-5},
      {"+2.5E+2", 250.0},
      {".5", 0.5},
      {"5.", 5.0},
      {"1e-320", 1e-320}};
  for (const auto& [text, value] : numbers)
    for (const std::string& file : filesWith(folder, text))
      EXPECT_EQ(read(file)->vertices[0].x(), value) << file << ": " << text;
}

TEST(MeshPrecision, NumbersThatNoMeshCanHaveAreRefused)
{
  const TemporaryFolder folder;
  for (const std::string& text :
       std::vector<std::string>{"100000000000000000000.0", "340000000000000000000000000000000000000", "3.4e38", "1e400",
                                "1e-400", "nan", "inf", "1,5", "1.5x", "0x10", "--1", "1.#IND", "1.0d0"})
    for (const std::string& file : filesWith(folder, text))
    {
      const std::string error = errorOf([&] { read(file); });
      EXPECT_NE(error.find(file), std::string::npos) << text;
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
}
}  // namespace
}  // namespace gpu_planning_scene::core
