#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "gpu_planning_scene/resources.h"
#include "model/mesh_files.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
using Corners = std::array<std::array<double, 3>, 3>;

// The edge lengths differ between the axes, so that exchanged axes are detected.
Mesh brick()
{
  return *tessellate(Box{{0.5, 1.0, 2.0}}).mesh;
}

// A mesh's triangles as positions, rounded to micrometres because files hold float32. Each triangle starts at its
// smallest corner; the triangles are in ascending order.
std::vector<Corners> triangles(const Mesh& mesh)
{
  std::vector<Corners> result;
  for (const auto& triangle : mesh.triangles)
  {
    Corners corners;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        corners[i][k] = std::round(mesh.vertices[triangle[i]][k] * 1e6) * 1e-6 + 0.0;
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    result.push_back(corners);
  }
  std::sort(result.begin(), result.end());
  return result;
}

Mesh transformed(Mesh mesh, const Eigen::Affine3d& transform)
{
  for (auto& vertex : mesh.vertices)
    vertex = transform * vertex;
  return mesh;
}

std::shared_ptr<const Mesh> load(const std::string& path, const Eigen::Vector3d& scale = Eigen::Vector3d::Ones())
{
  return MeshCache().load(path, scale);
}

double volume(const Mesh& mesh)
{
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
  return sum;
}

TEST(MeshCache, EveryFormatGivesTheSameMesh)
{
  const TemporaryFolder folder;
  const std::vector<std::string> files = {
      folder.write("ascii.stl", asciiStl(brick())),
      folder.write("binary.STL", binaryStl(brick())),
      folder.write("solid.stl", binaryStl(brick(), "solid made by a program that writes binary files")),
      folder.write("brick.obj", objText(brick())),
      folder.write("brick.ply", plyText(brick())),
      folder.write("brick.dae", daeText(brick()))};
  for (const std::string& file : files)
  {
    const auto mesh = load(file);
    EXPECT_EQ(triangles(*mesh), triangles(brick())) << file;
    EXPECT_EQ(mesh->vertices.size(), 8u) << file << ": equal vertices are not welded";
    EXPECT_EQ(mesh->name, file);
    EXPECT_EQ(errorOf([&] { validateMesh(*mesh); }), "");
  }
}

TEST(MeshCache, TheUnitOfAColladaFileAppliesAndItsUpAxisDoesNot)
{
  const TemporaryFolder folder;
  const Mesh centimetres = transformed(brick(), Eigen::Affine3d(Eigen::Scaling(100.0)));
  for (const char* up_axis : {"X_UP", "Y_UP", "Z_UP"})
  {
    const std::string file = folder.write(std::string(up_axis) + ".dae", daeText(centimetres, up_axis, 0.01));
    EXPECT_EQ(triangles(*load(file)), triangles(brick())) << up_axis;
  }
}

TEST(MeshCache, NodeTransformsOfAColladaFileApply)
{
  const TemporaryFolder folder;
  const Mesh centimetres = transformed(brick(), Eigen::Affine3d(Eigen::Scaling(100.0)));
  const std::string file = folder.write(
      "turned.dae", daeText(centimetres, "Y_UP", 0.01, "<translate>10 20 30</translate><rotate>0 0 1 90</rotate>"));
  const Eigen::Affine3d pose =
      Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::AngleAxisd(std::acos(-1.0) / 2.0, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(triangles(*load(file)), triangles(transformed(brick(), pose)));
}

TEST(MeshCache, ScalesApplyPerAxisAndMirroredMeshesStillFaceOutward)
{
  const TemporaryFolder folder;
  const std::string file = folder.write("brick.stl", binaryStl(brick()));
  const auto scaled = load(file, {2.0, 0.1, 3.0});
  EXPECT_EQ(triangles(*scaled), triangles(transformed(brick(), Eigen::Affine3d(Eigen::Scaling(2.0, 0.1, 3.0)))));

  const auto mirrored = load(file, {-1.0, 1.0, 1.0});
  EXPECT_NEAR(volume(*mirrored), volume(brick()), 1e-6);
  const auto mirrored_twice = load(file, {-1.0, 1.0, -1.0});
  EXPECT_NEAR(volume(*mirrored_twice), volume(brick()), 1e-6);
  const std::string flipped = folder.write("flipped.dae", daeText(brick(), "Z_UP", 1.0, "<scale>1 -1 1</scale>"));
  EXPECT_NEAR(volume(*load(flipped)), volume(brick()), 1e-6);
}

TEST(MeshCache, DegenerateAndDuplicateTrianglesAreKept)
{
  Mesh mesh = brick();
  mesh.triangles.push_back({0, 1, 1});
  mesh.triangles.push_back({2, 2, 2});
  mesh.triangles.push_back(mesh.triangles[0]);
  const TemporaryFolder folder;
  for (const std::string& file : {folder.write("a.stl", asciiStl(mesh)), folder.write("b.stl", binaryStl(mesh)),
                                  folder.write("c.obj", objText(mesh)), folder.write("d.ply", plyText(mesh)),
                                  folder.write("e.dae", daeText(mesh))})
    EXPECT_EQ(load(file)->triangles.size(), 15u) << file;
}

TEST(MeshCache, PolygonsAreTriangulatedAndPointsAndLinesLeftOut)
{
  const TemporaryFolder folder;
  // An L of area 3, which is not convex, and a line and a point.
  const std::string file =
      folder.write("l.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\nl 1 5\np 2\n");
  const auto mesh = load(file);
  EXPECT_EQ(mesh->triangles.size(), 4u);
  double area = 0.0;
  for (const auto& [a, b, c] : mesh->triangles)
  {
    const auto& v = mesh->vertices;
    area += 0.5 * (v[b] - v[a]).cross(v[c] - v[a]).z();
  }
  EXPECT_NEAR(area, 3.0, 1e-6);
}

TEST(MeshCache, AFileWithTheSameScaleIsLoadedOnce)
{
  const TemporaryFolder folder;
  const std::string file = folder.write("brick.stl", binaryStl(brick()));
  MeshCache cache;
  const auto mesh = cache.load(file, {1, 1, 1});
  EXPECT_NE(cache.load(file, {1, 1, 2}), mesh);
  std::filesystem::remove(file);
  EXPECT_EQ(cache.load(file, {1, 1, 1}), mesh);
}

TEST(MeshCache, ErrorsNameTheFileAndTheFault)
{
  const TemporaryFolder folder;
  Mesh empty = brick();
  empty.triangles.clear();
  Mesh infinite = brick();
  infinite.vertices[infinite.triangles[7][1]].x() = std::numeric_limits<double>::infinity();
  const std::string truncated = binaryStl(brick()).substr(0, 300);
  const std::string good = folder.write("good.stl", binaryStl(brick()));

  const auto expect_error =
      [](const std::string& path, const std::string& text, const Eigen::Vector3d& scale = Eigen::Vector3d::Ones())
  {
    const std::string error = errorOf([&] { load(path, scale); });
    EXPECT_NE(error.find(path), std::string::npos) << path << ": " << error;
    EXPECT_NE(error.find(text), std::string::npos) << path << ": " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  };
  expect_error(folder.path("missing.stl"), "does not exist");
  expect_error(folder.path("nowhere/meshes/a.stl"), "there is no folder '" + folder.path("nowhere") + "'");
  expect_error(folder.path(""), "only .stl");
  expect_error(folder.write("part.step", "x"), "only .stl, .dae, .obj and .ply");
  expect_error(folder.write("text.stl", "This is no mesh."), "cannot be read");
  expect_error(folder.write("truncated.stl", truncated), "cannot be read");
  expect_error(folder.write("zero.stl", ""), "cannot be read");
  expect_error(folder.write("empty_ascii.stl", asciiStl(empty)), "");
  expect_error(folder.write("empty.stl", binaryStl(empty)), "");
  expect_error(folder.write("empty.obj", objText(empty)), "no triangles");
  expect_error(folder.write("empty.ply", plyText(empty)), "");
  expect_error(folder.write("empty.dae", daeText(empty)), "no triangles");
  expect_error(folder.write("infinite.stl", binaryStl(infinite)), "is not finite");
  expect_error(good, "scale", {1.0, 0.0, 1.0});
  expect_error(good, "not finite", {1.0, std::numeric_limits<double>::quiet_NaN(), 1.0});
}
}  // namespace
}  // namespace gpu_planning_scene::core
