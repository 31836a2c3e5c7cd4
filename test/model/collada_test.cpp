// COLLADA files: scene graphs, primitives, and what is refused.

#include <gtest/gtest.h>

#include "gpu_planning_scene/mesh_reader.h"
#include "model/mesh_files.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
/// One triangle with different edges.
Mesh triangle()
{
  return {"", {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}, {{0, 1, 2}}};
}

/// A file with that triangle, with `from` replaced by `to`.
std::string changed(const std::string& from, const std::string& to)
{
  std::string text = daeText(triangle());
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

class Collada : public testing::Test
{
 protected:
  std::shared_ptr<const Mesh> read(const std::string& text) const
  {
    return readMeshFile(folder_.write("mesh.dae", text), Eigen::Vector3d::Ones());
  }

  std::string errorOfReading(const std::string& text) const
  {
    std::string error = errorOf([&] { read(text); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
  }

  void expectPlaced(const std::string& text, const Eigen::Affine3d& pose) const
  {
    const auto mesh = read(text);
    ASSERT_EQ(mesh->triangles.size(), 1u);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT((mesh->vertices[mesh->triangles[0][i]] - pose * triangle().vertices[i]).norm(), 1e-14) << i;
  }

  TemporaryFolder folder_;
};

Eigen::Affine3d turn(double degrees, const Eigen::Vector3d& axis)
{
  return Eigen::Affine3d(Eigen::AngleAxisd(degrees * std::acos(-1.0) / 180.0, axis.normalized()));
}

TEST_F(Collada, TransformsApplyFromTheLastToTheFirst)
{
  Eigen::Affine3d matrix = Eigen::Affine3d::Identity();
  matrix.matrix().topRows<3>() << 0, -1, 0, 5, 2, 0, 0, 6, 0, 0, 1, 7;
  expectPlaced(daeText(triangle(), "Z_UP", 1.0,
                       "<translate>1 2 3</translate><rotate>1 1 0 30</rotate><matrix>0 -1 0 5 2 0 0 6 0 0 1 7 "
                       "0 0 0 1</matrix><scale>1 2 3</scale><rotate>0 0 0 0</rotate>"),
               Eigen::Translation3d(1, 2, 3) * turn(30, {1, 1, 0}) * matrix * Eigen::Scaling(1.0, 2.0, 3.0));
}

TEST_F(Collada, ALookAtLooksAlongMinusZWithYUpwards)
{
  // From (1, 2, 3) along +x, with z upwards; the given direction upwards is inclined.
  Eigen::Affine3d pose(Eigen::Translation3d(1, 2, 3));
  pose.linear().col(0) = -Eigen::Vector3d::UnitY();
  pose.linear().col(1) = Eigen::Vector3d::UnitZ();
  pose.linear().col(2) = -Eigen::Vector3d::UnitX();
  expectPlaced(daeText(triangle(), "Z_UP", 1.0, "<lookat>1 2 3 5 2 3 1 0 1</lookat>"), pose);
}

TEST_F(Collada, ASkewOfNoDegreesChangesNothing)
{
  expectPlaced(daeText(triangle(), "Z_UP", 1.0, "<translate>1 2 3</translate><skew>0 0 0 0 0 0 0</skew>"),
               Eigen::Affine3d(Eigen::Translation3d(1, 2, 3)));
}

TEST_F(Collada, TransformsThatCannotBeReadAreNamed)
{
  const auto error = [&](const std::string& transform)
  { return errorOfReading(daeText(triangle(), "Z_UP", 1.0, transform)); };
  EXPECT_NE(error("<skew>45 0 1 0 1 0 0</skew>").find("<skew>: programs do not agree"), std::string::npos);
  EXPECT_NE(error("<skew>0 0 1 0</skew>").find("<skew>: it has 4 numbers, not 7"), std::string::npos);
  EXPECT_NE(error("<translate>1 2</translate>").find("<translate>: it has 2 numbers, not 3"), std::string::npos);
  EXPECT_NE(error("<rotate>0 0 0 90</rotate>").find("length 0"), std::string::npos);
  EXPECT_NE(error("<lookat>1 2 3 1 2 3 0 0 1</lookat>").find("length 0"), std::string::npos);
  EXPECT_NE(error("<lookat>1 2 3 1 2 5 0 0 1</lookat>").find("length 0"), std::string::npos);
  EXPECT_NE(error("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1</matrix>").find("last row"), std::string::npos);
}

TEST_F(Collada, InstancesOfNodesNestAndANodeCannotContainItself)
{
  const std::string library = R"(<library_nodes>
    <node id="pair"><instance_node url="#one"/><node><translate>0 10 0</translate><instance_node url="#one"/></node></node>
    <node id="one"><translate>1 0 0</translate><instance_geometry url="#g"/></node></library_nodes><library_visual_scenes>)";
  std::string text = changed("<library_visual_scenes>", library);
  text.replace(text.rfind("<instance_geometry"), 28, R"(<scale>2 2 2</scale><instance_node url="#pair"/>)");
  const auto mesh = read(text);
  ASSERT_EQ(mesh->triangles.size(), 2u);
  EXPECT_EQ(mesh->vertices[mesh->triangles[0][0]], Eigen::Vector3d(4, 0, 0));
  EXPECT_EQ(mesh->vertices[mesh->triangles[1][1]], Eigen::Vector3d(2, 24, 0));
  text.replace(text.find(R"(<instance_geometry url="#g"/></node></library_nodes>)"), 28,
               R"(<instance_node url="#pair"/>)");
  EXPECT_NE(errorOfReading(text).find("it contains itself"), std::string::npos);
}

TEST_F(Collada, AnUnknownElementOfANodeIsRefusedBecauseItMayHoldAMesh)
{
  const std::string instance = "<instance_geometry url=\"#g\"/>";
  for (const char* known : {"<extra><foo/></extra>", "<instance_light url=\"#l\"/>", "<instance_camera url=\"#c\"/>"})
    EXPECT_EQ("", errorOfReading(changed(instance, known + instance))) << known;
  EXPECT_NE(
      errorOfReading(changed(instance, instance + "<nodes>" + instance + "</nodes>")).find("unknown element <nodes>"),
      std::string::npos);
}

TEST_F(Collada, UnitsApplyOnce)
{
  expectPlaced(daeText(triangle(), "Z_UP", 0.01), Eigen::Affine3d(Eigen::Scaling(0.01)));
  EXPECT_EQ(errorOfReading(changed("<geometry id=\"g\">", "<geometry id=\"g\"><asset><unit meter=\"1\"/></asset>")),
            "");
  EXPECT_NE(errorOfReading(changed("<geometry id=\"g\">", "<geometry id=\"g\"><asset><unit meter=\"0.1\"/></asset>"))
                .find("another unit"),
            std::string::npos);
  for (const char* unit : {"0", "-1", "1cm", "0,01", "nan"})
    EXPECT_NE(errorOfReading(changed("meter=\"1\"", "meter=\"" + std::string(unit) + "\"")), "") << unit;
}

/// Replaces the triangle by other primitives of these points.
std::string withPrimitive(const std::string& points, int count, const std::string& primitive)
{
  std::string text = daeText(triangle());
  const std::size_t begin = text.find("<triangles");
  const std::size_t end = text.find("</triangles>") + 12;
  text.replace(begin, end - begin, primitive);
  const std::size_t array = text.find(" count=\"9\">") + 11;
  text.replace(array, text.find("</float_array>") - array, points);
  text.replace(text.find(" count=\"9\">"), 11, " count=\"" + std::to_string(3 * count) + "\">");
  const std::string accessor = "stride=\"3\" count=\"3\"";
  return text.replace(text.find(accessor), accessor.size(), "stride=\"3\" count=\"" + std::to_string(count) + "\"");
}

constexpr char kInput[] = R"(<input semantic="VERTEX" source="#v" offset="0"/>)";
/// A square of 4 m, and a square of 2 m in its middle.
constexpr char kSquares[] = "0 0 0 4 0 0 4 4 0 0 4 0 1 1 0 3 1 0 3 3 0 1 3 0";

double area(const Mesh& mesh)
{
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).z();
  return sum;
}

TEST_F(Collada, AllPrimitivesWithASurfaceAreRead)
{
  const std::string input = kInput;
  const std::pair<std::string, double> primitives[] = {
      {"<triangles count=\"2\">" + input + "<p>0 1 2 0 2 3</p></triangles>", 16.0},
      {"<polylist count=\"2\">" + input + "<vcount>4 3</vcount><p>0 1 2 3 4 5 6</p></polylist>", 18.0},
      {"<polylist count=\"1\">" + input + "<vcount>6</vcount><p>0 1 5 4 7 3</p></polylist>", 6.0},  // an L
      {"<polygons count=\"2\">" + input + "<p>0 1 2 3</p><p>4 5 6</p></polygons>", 18.0},
      {"<polygons count=\"1\">" + input + "<ph><p>0 1 2 3</p><h>4 5 6 7</h></ph></polygons>", 12.0},
      {"<polygons count=\"1\">" + input + "<ph><p>0 1 2 3</p><h>7 6 5 4</h></ph></polygons>", 12.0},
      {"<tristrips count=\"1\">" + input + "<p>0 1 3 2</p></tristrips>", 16.0},
      {"<trifans count=\"2\">" + input + "<p>0 1 2 3</p><p>4 5 6</p></trifans>", 18.0},
      {"<triangles count=\"1\">" + input + R"(<input semantic="NORMAL" source="#n" offset="2"/>)" +
           "<p>0 7 7 1 7 7 <!-- a comment --> 2 7 7</p></triangles>",
       8.0},
      {"<lines count=\"1\">" + input + "<p>0 1</p></lines><triangles count=\"1\">" + input + "<p>0 1 2</p></triangles>",
       8.0},
      {"<triangles count=\"0\"/><triangles count=\"1\">" + input + "<p>0 1 2</p></triangles>", 8.0}};
  for (const auto& [primitive, expected] : primitives)
    EXPECT_DOUBLE_EQ(area(*read(withPrimitive(kSquares, 8, primitive))), expected) << primitive;
}

TEST_F(Collada, PrimitivesThatDoNotFitAreRefused)
{
  const std::string input = kInput;
  const std::pair<std::string, std::string> primitives[] = {
      {"<triangles count=\"1\">" + input + "<p>0 1 2 0 2 3</p></triangles>", "its count says 1"},
      {"<triangles count=\"1\">" + input + "<p>0 1 2 3</p></triangles>", "lacks corners"},
      {"<triangles count=\"1\">" + input + "<p>0 1 8</p></triangles>", "names vertex 8, but there are 8"},
      {"<triangles count=\"1\">" + input + "<p>0 1 -1</p></triangles>", "names vertex -1"},
      {"<triangles count=\"1\">" + input + "<p>0 1 x</p></triangles>", "'x' is not an integer"},
      {"<triangles count=\"1\"><p>0 1 2</p></triangles>", "no <input> with the semantic VERTEX"},
      {"<triangles count=\"1\">" + input + input + "<p>0 1 2</p></triangles>", "twice"},
      {"<polylist count=\"1\">" + input + "<vcount>4</vcount><p>0 1 2</p></polylist>", "more corners than <p>"},
      {"<polylist count=\"1\">" + input + "<vcount>3</vcount><p>0 1 2 3</p></polylist>", "more corners than <vcount>"},
      {"<polylist count=\"1\">" + input + "<vcount>-3</vcount><p>0 1 2 3</p></polylist>", "more corners than"},
      {"<polygons count=\"1\">" + input + "<ph><p>4 5 6 7</p><h>0 1 2 3</h></ph></polygons>", "hole"},
      {"<quads count=\"1\">" + input + "<p>0 1 2 3</p></quads>", "<quads>: it cannot be read"}};
  for (const auto& [primitive, error] : primitives)
    EXPECT_NE(errorOfReading(withPrimitive(kSquares, 8, primitive)).find(error), std::string::npos)
        << primitive << "\n"
        << errorOfReading(withPrimitive(kSquares, 8, primitive));
}

TEST_F(Collada, SourcesThatDoNotFitAreRefused)
{
  const std::array<std::string, 3> changes[] = {
      {"count=\"9\"", "count=\"12\"", "has 9 numbers, but its count says 12"},
      {"stride=\"3\" count=\"3\"", "stride=\"3\" count=\"4\"", "more numbers than its <float_array>"},
      {"stride=\"3\" count=\"3\"", "stride=\"3\" count=\"3\" offset=\"1\"", "more numbers than its <float_array>"},
      {"stride=\"3\" count=\"3\"", "stride=\"2\" count=\"3\"", "stride is smaller"},
      {"stride=\"3\" count=\"3\"", "stride=\"0\" count=\"3\"", "stride is smaller"},
      {"name=\"Y\"", "name=\"X\"", "X, Y and Z once each"},
      {"name=\"Z\" ", "", "X, Y and Z once each"},
      {"source=\"#a\"", "source=\"#b\"", "no <float_array> with the id 'b'"},
      {"source=\"#a\"", "source=\"other.dae#a\"", "is not in this file"},
      {"url=\"#g\"", "url=\"#h\"", "no <geometry> with the id 'h'"},
      {"<instance_geometry url=\"#g\"/>", "<instance_controller url=\"#g\"/>", "a mesh that a skeleton deforms"},
      {"<mesh>", "<brep/><mesh>", "<brep>: it cannot be read"},
      {"<scene>", "<library_visual_scenes><visual_scene id=\"s\"/></library_visual_scenes><scene>",
       "two <visual_scene>"},
      {"</COLLADA>", "</COLADA>", "malformed"},
      {"<COLLADA", "<COLADA", "malformed"}};
  for (const auto& [from, to, error] : changes)
    EXPECT_NE(errorOfReading(changed(from, to)).find(error), std::string::npos) << to << "\n"
                                                                                << errorOfReading(changed(from, to));
}

TEST_F(Collada, AFileWithoutASceneElementMayHaveOneScene)
{
  const std::string scene = "<scene><instance_visual_scene url=\"#s\"/></scene>";
  EXPECT_EQ(read(changed(scene, ""))->triangles.size(), 1u);
  std::string two = changed(scene, "");
  two.insert(two.find("</library_visual_scenes>"), "<visual_scene id=\"t\"/>");
  EXPECT_NE(errorOfReading(two), "");
}
}  // namespace
}  // namespace gpu_planning_scene::core
