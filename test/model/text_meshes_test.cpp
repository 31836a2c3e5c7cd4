// The statements of OBJ and ASCII STL files.

#include <gtest/gtest.h>

#include "gpu_planning_scene/mesh_reader.h"
#include "model/mesh_files.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
std::shared_ptr<const Mesh> read(const TemporaryFolder& folder, const std::string& name, const std::string& content)
{
  return readMeshFile(folder.write(name, content), Eigen::Vector3d::Ones());
}

void expectError(const std::string& name, const std::string& content, const std::string& text)
{
  const TemporaryFolder folder;
  const std::string error = errorOf([&] { read(folder, name, content); });
  EXPECT_NE(error.find(text), std::string::npos) << content << "\n" << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

const std::string kPoints = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, FacesNameVerticesInAllForms)
{
  const TemporaryFolder folder;
  for (const char* face : {"f 1 2 3", "f 1/9 2/9 3/9", "f 1//9 2//9 3//9", "f 1/9/9 2/9/9 3/9/9", "f -4 -3 -2",
                           "f -4/-1/-1 -3/-1/-1 -2/-1/-1", "f 1 2 \\\n 3", "  f\t1 2 3 # a comment", "fo 1 2 3"})
  {
    const auto mesh = read(folder, "a.obj", kPoints + face);
    ASSERT_EQ(mesh->triangles.size(), 1u) << face;
    EXPECT_EQ(mesh->vertices, (std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}})) << face;
  }
  const auto later = read(folder, "a.obj", "f 1 2 3\n" + kPoints);
  EXPECT_EQ(later->triangles.size(), 1u) << "a vertex may come after the face";
}

TEST(Obj, EndsOfLinesAndAMarkOfUtf8DoNotMatter)
{
  const TemporaryFolder folder;
  for (const std::string end : {"\n", "\r\n", "\r"})
  {
    std::string text = "\xEF\xBB\xBF# a comment\n" + kPoints + "f 1 2 3 \\\n4";
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size())
      text.replace(at, 1, end);
    EXPECT_EQ(read(folder, "a.obj", text)->triangles.size(), 2u) << end.size();
  }
}

TEST(Obj, OnlyStatementsWithoutASurfaceAreLeftOut)
{
  const TemporaryFolder folder;
  const std::string rest = "mtllib a.mtl\no a\ng b c\ns off\nusemtl m\nvn 0 0 1\nvt 0 0\nl 1 2\np 1\nf 1 2\nf 1 2 3\n";
  EXPECT_EQ(read(folder, "a.obj", kPoints + rest)->triangles.size(), 1u);
  EXPECT_EQ(read(folder, "a.obj", "v 0 0 0 1 0 0\nv 1 0 0 1.0\nv 0 1 0\nf 1 2 3\n")->triangles.size(), 1u);
  for (const char* statement :
       {"cstype bspline", "surf 0 1 0 1 1 2 3 4", "curv 0 1 1 2 3", "call other.obj", "face 1 2 3"})
    expectError("a.obj", kPoints + statement + "\nf 1 2 3\n", "line 5: the statement '");
}

TEST(Obj, ErrorsNameTheLine)
{
  expectError("a.obj", "v 0 0\n", "line 1: a vertex has 2 numbers, not 3");
  expectError("a.obj", "v 0 0 0 0 1\n", "a vertex has 5 numbers");
  expectError("a.obj", "v 0 0 0 2\n", "weight that is not 1");
  expectError("a.obj", "\nv 0 0 1,5\n", "line 2: '1,5' is not a number");
  expectError("a.obj", kPoints + "f 1 2 5\n", "line 5: a face names a vertex that the file does not have");
  expectError("a.obj", kPoints + "f 0 1 2\n", "line 5: a face names a vertex that the file does not have");
  expectError("a.obj", kPoints + "f -5 1 2\n", "line 5: a face names a vertex that the file does not have");
  expectError("a.obj", kPoints + "f 1 2 3x\n", "line 5: '3x' is not an integer");
  expectError("a.obj", kPoints + "f 1/x 2 3\n", "line 5: '1/x' is no corner");
  expectError("a.obj", kPoints, "no triangles");
}

std::string facet(const std::string& vertices = "vertex 0 0 0 vertex 1 0 0 vertex 0 1 0")
{
  return "facet normal nan nan nan outer loop " + vertices + " endloop endfacet\n";
}

TEST(AsciiStl, SeveralSolidsAndCapitalsAreRead)
{
  const TemporaryFolder folder;
  const std::string two = "solid facet normal\n" + facet() + facet() + "endsolid facet\nsolid\n" + facet() + "endsolid";
  EXPECT_EQ(read(folder, "a.stl", two)->triangles.size(), 3u);
  std::string capitals = two;
  std::transform(capitals.begin(), capitals.end(), capitals.begin(), [](unsigned char c) { return std::toupper(c); });
  EXPECT_EQ(read(folder, "a.stl", capitals)->triangles.size(), 3u);
}

TEST(AsciiStl, ErrorsNameTheLine)
{
  expectError("a.stl", "solid a\n" + facet(), "ends before 'endsolid'");
  expectError("a.stl", "solid a\n" + facet() + facet("vertex 0 0 0 vertex 1 0 0") + "endsolid\n",
              "line 3: expected 'vertex', found 'endloop'");
  expectError("a.stl", "solid a\n" + facet("vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 vertex 0 1 0") + "endsolid\n",
              "line 2: expected 'endloop', found 'vertex'");
  expectError("a.stl", "solid a\n" + facet("vertex 0 0 0 vertex 1 0 0 vertex 1 1") + "endsolid\n",
              "line 2: 'endloop' is not a number");
  expectError("a.stl", "solid a\nendsolid\n", "no triangles");
  expectError("a.stl", "soild a\nendsoild\n", "no ASCII STL, which begins with 'solid'");
}

TEST(BinaryStl, TheSizeMustFit)
{
  const Mesh mesh{"", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}};
  for (const char* header : {"", "solid "})
  {
    const std::string content = binaryStl(mesh, header);
    const TemporaryFolder folder;
    EXPECT_EQ(read(folder, "a.stl", content)->triangles.size(), 2u);
    expectError("a.stl", content.substr(0, content.size() - 1), "has 184 bytes, not 183");
    expectError("a.stl", content + "x", "has 184 bytes, not 185");
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
