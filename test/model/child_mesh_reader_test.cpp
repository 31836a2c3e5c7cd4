#include <filesystem>
#include <limits>

#include <fcntl.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "gpu_planning_scene/mesh_reader.h"
#include "model/files/mesh_pipe.h"
#include "model/mesh_files.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
// A grid of 2 n^2 triangles.
Mesh sheet(int n)
{
  Mesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k)
      mesh.vertices.push_back(Eigen::Vector3d(i, k, i * k) / 128.0);
  const auto index = [n](int i, int k) { return static_cast<std::uint32_t>(i * (n + 1) + k); };
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
    {
      mesh.triangles.push_back({index(i, k), index(i + 1, k), index(i, k + 1)});
      mesh.triangles.push_back({index(i + 1, k), index(i + 1, k + 1), index(i, k + 1)});
    }
  return mesh;
}

std::string errorOfReading(const std::string& program, const std::string& path, const MeshLimits& limits)
{
  const ReadMesh read = childMeshReader(program, limits);
  std::string error = errorOf([&] { read(path, Eigen::Vector3d::Ones()); });
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  EXPECT_NE(error.find(path), std::string::npos) << "the file is not named: " << error;
  return error;
}

MeshLimits quick()
{
  MeshLimits limits;
  limits.seconds = 10.0;
  limits.triangles = 1000;
  return limits;
}

TEST(ChildMeshReader, GivesTheMeshThatThisProcessWouldRead)
{
  const TemporaryFolder folder;
  const std::string path = folder.write("a mesh.stl", binaryStl(sheet(30)));
  const Eigen::Vector3d scale(0.1, -1.0 / 3.0, 3.0);
  const auto expected = readMeshFile(path, scale);
  MeshLimits limits;
  const auto mesh = MeshCache(childMeshReader(GPS_READ_MESH, limits)).load(path, scale);
  EXPECT_EQ(mesh->vertices, expected->vertices);
  EXPECT_EQ(mesh->triangles, expected->triangles);
  EXPECT_EQ(mesh->name, path);
}

TEST(ChildMeshReader, TheMessageOfTheReaderIsTheError)
{
  const TemporaryFolder folder;
  const std::string path = folder.write("bad.stl", "solid of nothing");
  const std::string error = errorOfReading(GPS_READ_MESH, path, quick());
  EXPECT_EQ(error, errorOf([&] { readMeshFile(path, Eigen::Vector3d::Ones()); }));
  EXPECT_NE(errorOfReading(GPS_READ_MESH, folder.path("none.stl"), quick()).find("does not exist"), std::string::npos);
}

TEST(ChildMeshReader, ACrashOfTheReaderIsAnError)
{
  EXPECT_NE(errorOfReading(GPS_FAULTY_MESH_READER, "/x/crash.stl", quick()).find("crashed (signal 11)"),
            std::string::npos);
  EXPECT_NE(errorOfReading(GPS_FAULTY_MESH_READER, "/x/exit.stl", quick()).find("exit code 42"), std::string::npos);
}

TEST(ChildMeshReader, AReaderThatHangsIsStopped)
{
  MeshLimits limits = quick();
  limits.seconds = 0.2;
  for (const char* path : {"/x/hang.stl", "/x/linger.stl"})
    EXPECT_NE(errorOfReading(GPS_FAULTY_MESH_READER, path, limits).find("longer than 0.2"), std::string::npos) << path;
}

TEST(ChildMeshReader, EndlessOutputIsCutOff)
{
  for (const char* path : {"/x/babble.stl", "/x/complain.stl"})
    EXPECT_NE(errorOfReading(GPS_FAULTY_MESH_READER, path, quick()).find("more data than a mesh of 1000 triangles"),
              std::string::npos)
        << path;
}

TEST(ChildMeshReader, WrongLengthIsRefused)
{
  for (const char* path : {"/x/lie.stl", "/x/short.stl", "/x/empty.stl"})
    EXPECT_NE(errorOfReading(GPS_FAULTY_MESH_READER, path, quick()), "") << path;
}

TEST(ChildMeshReader, LargeFilesAndManyTrianglesAreRefused)
{
  const TemporaryFolder folder;
  const std::string path = folder.write("sheet.stl", binaryStl(sheet(30)));  // 1800 triangles
  const std::string many = errorOfReading(GPS_READ_MESH, path, quick());
  EXPECT_NE(many.find("1800 triangles; at most 1000"), std::string::npos) << many;
  MeshLimits limits;
  limits.file = 1000;
  const std::string large = errorOfReading(GPS_READ_MESH, path, limits);
  EXPECT_NE(large.find("at most 1000 are allowed (~mesh/file_size)"), std::string::npos) << large;
}

TEST(ChildMeshReader, AFileThatNeedsTooMuchMemoryIsRefused)
{
#ifdef GPS_SANITIZED
  GTEST_SKIP() << "the address sanitizer takes more addresses than any limit";
#endif
  const TemporaryFolder folder;
  const std::string small = folder.write("small.stl", binaryStl(sheet(3)));
  const std::string large = folder.write("large.stl", binaryStl(sheet(600)));
  MeshLimits limits;
  limits.memory = 40 << 20;  // the bytes of the large file are 34 MiB, and their mesh needs as many again
  EXPECT_EQ(childMeshReader(GPS_READ_MESH, limits)(small, Eigen::Vector3d::Ones())->triangles.size(), 18u);
  const std::string error = errorOfReading(GPS_READ_MESH, large, limits);
  EXPECT_NE(error.find("needs more than 40 MiB"), std::string::npos) << error;
}

TEST(ChildMeshReader, FilesThatAreOpenInThisProcessAreClosedInTheReader)
{
  const TemporaryFolder folder;
  const std::string path = folder.write("sheet.stl", binaryStl(sheet(3)));
  const int inherited = open(path.c_str(), O_RDONLY);  // without O_CLOEXEC
  ASSERT_GT(inherited, STDERR_FILENO);
  const std::string link = folder.path("link.stl");
  std::filesystem::create_symlink("/proc/self/fd/" + std::to_string(inherited), link);
  EXPECT_EQ(readMeshFile(link, Eigen::Vector3d::Ones())->triangles.size(), 18u) << "open in this process";
  EXPECT_NE(errorOfReading(GPS_READ_MESH, link, quick()).find("does not exist"), std::string::npos);
  const std::string by_default = errorOf([&] { MeshCache().load(link, Eigen::Vector3d::Ones()); });
  EXPECT_NE(by_default.find("does not exist"), std::string::npos)
      << "the default reads in another process: " << by_default;
  close(inherited);
}

TEST(ChildMeshReader, AProgramThatIsNotThereIsNamed)
{
  const ReadMesh read = childMeshReader("/no/such/read_mesh", quick());
  const std::string error = errorOf([&] { read("/x/a.stl", Eigen::Vector3d::Ones()); });
  EXPECT_NE(error.find("/no/such/read_mesh"), std::string::npos) << error;
}

TEST(ChildMeshReader, RobotsAreReadThroughIt)
{
  const TemporaryFolder folder;
  folder.write("part.stl", binaryStl(sheet(3)));
  const std::string urdf = folder.write(
      "robot.urdf", R"(<robot name="r"><link name="a"><collision><geometry><mesh filename="part.stl"/></geometry>
        </collision></link></robot>)");
  RobotModelOptions options;
  options.meshes.read = childMeshReader(GPS_FAULTY_MESH_READER, quick());
  EXPECT_NE(errorOf([&] { RobotModel::fromFiles(urdf, "", options); }), "");
  options.meshes.read = childMeshReader(GPS_READ_MESH, quick());
  EXPECT_EQ(RobotModel::fromFiles(urdf, "", options)->triangleCount(), 18u);
  options.meshes.roots = AllowedRoots();
  options.meshes.roots->roots = {folder.path("elsewhere")};
  EXPECT_EQ(RobotModel::fromFiles(urdf, "", options)->triangleCount(), 18u) << "relative to the URDF";
  const std::string outside =
      folder.write("urdf/robot.urdf",
                   R"(<robot name="r"><link name="a"><collision><geometry><mesh filename="../part.stl"/></geometry>
        </collision></link></robot>)");
  EXPECT_NE(errorOf([&] { RobotModel::fromFiles(outside, "", options); }).find("~mesh/roots"), std::string::npos);
}

TEST(MeshPipe, BytesAreNotTrusted)
{
  const Mesh mesh = sheet(2);
  const std::string good = meshBytes(mesh);
  const auto fault = [](const std::string& bytes) { return errorOf([&] { meshFromBytes(bytes, "m.stl", 100); }); };
  EXPECT_EQ(fault(good), "");
  EXPECT_NE(fault(good + "x"), "");
  EXPECT_NE(fault(good.substr(0, good.size() - 1)), "");
  EXPECT_NE(fault(""), "");
  EXPECT_NE(errorOf([&] { meshFromBytes(good, "m.stl", 7); }).find("8 triangles"), std::string::npos);
  Mesh wrong = mesh;
  wrong.triangles[3][1] = 9;
  EXPECT_NE(fault(meshBytes(wrong)), "") << "an index out of range";
  wrong = mesh;
  wrong.vertices[0].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(fault(meshBytes(wrong)), "") << "a vertex that is not finite";
}
}  // namespace
}  // namespace gpu_planning_scene::core
