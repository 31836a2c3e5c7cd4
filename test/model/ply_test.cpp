// PLY files with random types, byte orders and further values. The independent implementation is the writer below.

#include <array>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "gpu_planning_scene/mesh_reader.h"
#include "model/mesh_files.h"
#include "model/model_testing.h"
#include "support/repetitions.h"

namespace gpu_planning_scene::core
{
namespace
{
enum class Coding
{
  Ascii,
  LittleEndian,
  BigEndian
};

const std::array<const char*, 8> kNames = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
const std::array<const char*, 8> kSizedNames = {"int8",  "uint8",  "int16",   "uint16",
                                                "int32", "uint32", "float32", "float64"};
constexpr int kFloat = 6;

/// Writes the values of a PLY file.
class Writer
{
 public:
  explicit Writer(Coding coding) : coding_(coding) { text_.precision(17); }

  void write(int type, double value)
  {
    switch (type)
    {
      case 0:
        return append(static_cast<std::int8_t>(value));
      case 1:
        return append(static_cast<std::uint8_t>(value));
      case 2:
        return append(static_cast<std::int16_t>(value));
      case 3:
        return append(static_cast<std::uint16_t>(value));
      case 4:
        return append(static_cast<std::int32_t>(value));
      case 5:
        return append(static_cast<std::uint32_t>(value));
      case kFloat:
        return append(static_cast<float>(value));
      default:
        return append(value);
    }
  }
  void endLine()
  {
    if (coding_ == Coding::Ascii)
      text_ << "\n";
  }
  std::string written() const { return coding_ == Coding::Ascii ? text_.str() : bytes_; }

 private:
  template <typename Value>
  void append(Value value)
  {
    if (coding_ == Coding::Ascii)
    {
      text_ << +value << " ";
      return;
    }
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);  // this machine is little-endian
    if (coding_ == Coding::BigEndian)
      std::reverse(std::begin(bytes), std::end(bytes));
    bytes_.append(bytes, sizeof value);
  }

  Coding coding_;
  std::ostringstream text_;
  std::string bytes_;
};

/// A random form of a file: types, order of elements and properties, further values. The same `seed` gives the same
/// form for all codings.
std::string plyFile(const Mesh& mesh, Coding coding, unsigned seed)
{
  std::mt19937 random(seed);
  const auto below = [&](int end) { return std::uniform_int_distribution<int>(0, end - 1)(random); };
  const auto& names = below(2) == 0 ? kNames : kSizedNames;
  const std::string end = coding == Coding::Ascii || below(2) == 0 ? "\n" : "\r\n";
  const int coordinate = seed % 3 == 0 ? below(6) : kFloat + below(2);
  const int length = below(6);
  const int index = below(8);
  const int extra = below(8);
  const bool has_extra = below(2) == 0;
  const bool faces_first = below(2) == 0;
  std::array<int, 3> axes{0, 1, 2};
  std::shuffle(axes.begin(), axes.end(), random);

  const char* const formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  std::string header =
      "ply" + end + "format " + formats[static_cast<int>(coding)] + " 1.0" + end + "comment x y z" + end;
  Writer values(coding);
  const auto vertices = [&]
  {
    header += "element vertex " + std::to_string(mesh.vertices.size()) + end;
    for (const int axis : axes)
    {
      header += std::string("property ") + names[coordinate] + " " + "xyz"[axis] + end;
      if (has_extra)
        header += std::string("property ") + names[extra] + " e" + std::to_string(axis) + end;
    }
    for (const auto& vertex : mesh.vertices)
    {
      for (const int axis : axes)
      {
        values.write(coordinate, vertex[axis]);
        if (has_extra)
          values.write(extra, 10);  // an end of a line in binary files
      }
      values.endLine();
    }
  };
  const auto faces = [&]
  {
    header += "obj_info property float x" + end + "element face " + std::to_string(mesh.triangles.size()) + end;
    if (has_extra)
      header += std::string("property list uchar ") + names[extra] + " texcoord" + end;
    header += std::string("property list ") + names[length] + " " + names[index] +
              (seed % 2 == 0 ? " vertex_indices" : " vertex_index") + end;
    for (const auto& triangle : mesh.triangles)
    {
      if (has_extra)
      {
        values.write(1, 2);
        values.write(extra, 13);
        values.write(extra, 3);
      }
      values.write(length, 3);
      for (const std::uint32_t corner : triangle)
        values.write(index, corner);
      values.endLine();
    }
  };
  if (faces_first)
    faces();
  header += "element material 2" + end + "property " + names[extra] + " shine" + end;
  for (int i = 0; i < 2; ++i)
  {
    values.write(extra, 10);
    values.endLine();
  }
  vertices();
  if (!faces_first)
    faces();
  return header + "end_header" + end + values.written();
}

/// PlacedTriangles of a grid of integers, which all types can hold. Many coordinates and indices are 10 or 13, the
/// bytes of ends of lines.
Mesh gridMesh(std::mt19937& random)
{
  std::uniform_int_distribution<int> place(0, 14);
  std::set<std::array<int, 3>> places;
  while (places.size() < 30)
    places.insert({place(random), place(random), place(random)});
  Mesh mesh;
  for (const auto& [x, y, z] : places)
    mesh.vertices.emplace_back(x, y, z);
  std::uniform_int_distribution<std::uint32_t> corner(0, 29);
  for (int i = 0; i < 20; ++i)
    mesh.triangles.push_back({corner(random), corner(random), corner(random)});
  return mesh;
}

using PlacedTriangles = std::vector<std::array<Eigen::Vector3d, 3>>;

PlacedTriangles trianglesOf(const Mesh& mesh)
{
  PlacedTriangles triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  return triangles;
}

TEST(Ply, AllTypesAndByteOrdersGiveTheSameMesh)
{
  const TemporaryFolder folder;
  for (unsigned seed = 0; seed < repetitions(100U, 20000U); ++seed)
  {
    std::mt19937 random(seed);
    Mesh mesh = gridMesh(random);
    if (seed % 3 != 0)  // the coordinates have a float type
      for (Eigen::Vector3d& vertex : mesh.vertices)
        vertex *= 0.25;
    for (const Coding coding : {Coding::Ascii, Coding::LittleEndian, Coding::BigEndian})
    {
      const std::string content = plyFile(mesh, coding, seed);
      const std::string path = folder.write("mesh.ply", content);
      std::shared_ptr<const Mesh> read;
      EXPECT_EQ(errorOf([&] { read = readMeshFile(path, Eigen::Vector3d::Ones()); }), "") << "seed " << seed;
      if (read)
        EXPECT_EQ(trianglesOf(*read), trianglesOf(mesh)) << "seed " << seed << "\n" << content.substr(0, 400);
    }
  }
}

TEST(Ply, DamagedBinaryFilesAreRefused)
{
  // A file that lost or gained a byte, or whose ends of lines a transfer as text has changed.
  const TemporaryFolder folder;
  const auto error = [&](const std::string& content)
  { return errorOf([&] { readMeshFile(folder.write("mesh.ply", content), Eigen::Vector3d::Ones()); }); };
  for (unsigned seed = 1; seed < repetitions(60U, 10000U); ++seed)
  {
    std::mt19937 random(seed);
    const Mesh mesh = gridMesh(random);
    const std::string content = plyFile(mesh, seed % 2 == 0 ? Coding::LittleEndian : Coding::BigEndian, 3 * seed + 1);
    EXPECT_NE(error(content.substr(0, content.size() - 1)), "") << "seed " << seed;
    EXPECT_NE(error(content + "\n"), "") << "seed " << seed;
    if (content.find('\n', content.find("end_header") + 12) == std::string::npos)
      continue;  // a transfer as text changes none of its values
    std::string as_text;
    for (const char c : content)
      as_text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_NE(error(as_text), "") << "seed " << seed;
  }
}

std::string ascii(const std::string& header, const std::string& values)
{
  return "ply\nformat ascii 1.0\n" + header + "end_header\n" + values;
}

const char* const kVertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const char* const kFaces = "element face 1\nproperty list uchar int vertex_indices\n";
const char* const kFourPoints = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(Ply, ErrorsNameThePlaceAndTheFault)
{
  const TemporaryFolder folder;
  const auto expect_error = [&](const std::string& content, const std::string& text)
  {
    const std::string path = folder.write("mesh.ply", content);
    const std::string error = errorOf([&] { readMeshFile(path, Eigen::Vector3d::Ones()); });
    EXPECT_NE(error.find(text), std::string::npos) << error;
    EXPECT_NE(error.find(path), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  };
  const std::string v = kVertices;
  const std::string f = kFaces;
  const std::string points = kFourPoints;
  expect_error("", "begins with a line 'ply'");
  expect_error("plx\n", "begins with a line 'ply'");
  expect_error("ply\nformat ascii 1.0\nelement vertex 4\n", "ends before 'end_header'");
  expect_error("ply\nformat binary 1.0\nend_header\n", "line 2: expected 'format'");
  expect_error("ply\nformat ascii 1.0\r\nend_header\n", "end in different ways");
  expect_error(ascii("element vertex -1\n", ""), "is '-1'");
  expect_error(ascii("property float x\n", ""), "before the first element");
  expect_error(ascii("element vertex 1\nproperty long x\n", ""), "'long' is no type");
  expect_error(ascii("element vertex 1\nproperty list float int x\n", ""), "integer type");
  expect_error(ascii(v + "property float x\n", ""), "twice");
  expect_error(ascii(v + v, ""), "twice");
  expect_error(ascii(v + "propety float r\n", ""), "'propety' is no statement");
  expect_error(ascii("element vertex 1\nproperty float x\nproperty float y\n", "0 0\n"), "properties x, y and z");
  expect_error(ascii(v + "element face 1\nproperty int a\n", points + "3\n"), "one list 'vertex_indices'");
  expect_error(ascii(v + "element patch 1\nproperty list uchar int vertex_indices\n", points + "3 0 1 2\n"),
               "element 'patch' cannot be read");
  expect_error(ascii(v + f, points + "3 0 1 4\n"), "names vertex 4, but there are 4");
  expect_error(ascii(v + f, points + "3 0 1 -2\n"), "line 14: a face has a number of a vertex that is negative");
  expect_error(ascii(v + f, points + "3 0 1 1.5\n"), "'1.5' is not an integer");
  expect_error(ascii(v + f, points + "300 0 1 2\n"), "'300' is out of the range");
  expect_error(ascii(v + f, points + "3 0 1\n"), "ends before the last");
  expect_error(ascii(v + f, points + "3 0 1 2 3\n"), "goes on after the last");
  expect_error(ascii(v + f, "0 0 zero\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), "line 10: 'zero' is not a number");
  expect_error(ascii(v + f, "0 0 nan\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), "'nan' is not finite");
  expect_error(ascii(v + f, "0 0 1e20\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), "farther than 1000 km");
  expect_error(ascii(v, points), "no triangles");
}

TEST(Ply, AnElementWithoutPropertiesTakesNoTime)
{
  const TemporaryFolder folder;
  const std::string path =
      folder.write("mesh.ply", ascii("element nothing 1000000000000\n" + std::string(kVertices) + kFaces,
                                     std::string(kFourPoints) + "3 0 1 2\n"));
  EXPECT_EQ(readMeshFile(path, Eigen::Vector3d::Ones())->triangles.size(), 1u);
}

TEST(Ply, PolygonsAndStripsBecomeTriangles)
{
  const TemporaryFolder folder;
  const auto count = [&](const std::string& header, const std::string& values)
  {
    const std::string path = folder.write("mesh.ply", ascii(kVertices + header, kFourPoints + values));
    return readMeshFile(path, Eigen::Vector3d::Ones())->triangles.size();
  };
  EXPECT_EQ(count("element face 2\nproperty list uchar int vertex_indices\n", "4 0 1 2 3\n2 0 1\n"), 2u);
  // The second triangle of a strip turns around; -1 begins a new one, and a repeated corner joins two.
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  EXPECT_EQ(count(strips, "9 0 1 3 2 -1 1 1 2 3\n"), 3u);
  const std::string path =
      folder.write("mesh.ply", ascii(kVertices + strips, std::string(kFourPoints) + "4 0 1 3 2\n"));
  for (const auto& [a, b, c] : trianglesOf(*readMeshFile(path, Eigen::Vector3d::Ones())))
    EXPECT_GT((b - a).cross(c - a).z(), 0.0);
}
}  // namespace
}  // namespace gpu_planning_scene::core
