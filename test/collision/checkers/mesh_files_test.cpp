// What a ball hits depends on the shape that a mesh file describes, and not on its format.

#include <filesystem>

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/resources.h"
#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
bool hits(const std::shared_ptr<const Mesh>& mesh, double radius, const Eigen::Vector3d& centre)
{
  PlanningScene scene(robotOf(R"(<link name="base"/><link name="ball"><collision><geometry><sphere radius=")" +
                              std::to_string(radius) + R"("/></geometry></collision></link>)" +
                              jointXml("slide", "prismatic", "base", "ball", kLimits)));
  WorldObject object;
  object.id = "mesh";
  object.pose.translation() = -centre;  // exact for the centres of these tests
  object.shapes.push_back({mesh, Eigen::Isometry3d::Identity()});
  scene.objects.push_back(object);
  const double at_origin = 0.0;
  return CpuChecker(std::make_shared<PlanningScene>(scene)).check(&at_origin, 1).valid[0] == 0;
}

bool hits(const std::string& path, double radius, const Eigen::Vector3d& centre)
{
  return hits(MeshCache().load(path, Eigen::Vector3d::Ones()), radius, centre);
}

TEST(MeshFiles, TheNotchOfAConcaveFaceIsFreeInEachFormat)
{
  const TemporaryFolder folder;
  const std::string obj =
      folder.write("l.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n");
  const std::string ply = folder.write(
      "l.ply",
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nelement face "
      "1\nproperty list uchar uint vertex_index\nend_header\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n6 0 1 2 3 4 "
      "5\n");
  const std::string dae = folder.write("l.dae", R"(<COLLADA><library_geometries><geometry id="g"><mesh><source id="p">
    <float_array id="a" count="18">0 0 0 2 0 0 2 1 0 1 1 0 1 2 0 0 2 0</float_array><technique_common>
    <accessor source="#a" stride="3" count="6"><param name="X"/><param name="Y"/><param name="Z"/></accessor>
    </technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><polylist count="1">
    <input semantic="VERTEX" source="#v" offset="0"/><vcount>6</vcount><p>0 1 2 3 4 5</p></polylist></mesh></geometry>
    </library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node>
    </visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
  for (const std::string& file : {obj, ply, dae})
  {
    EXPECT_FALSE(hits(file, 0.05, {1.3, 1.3, 0.0})) << file;
    EXPECT_FALSE(hits(file, 0.05, {1.06, 1.06, 0.0})) << file;
    EXPECT_TRUE(hits(file, 0.05, {0.5, 1.5, 0.0})) << file;
    EXPECT_TRUE(hits(file, 0.05, {1.5, 0.5, 0.0})) << file;
    EXPECT_TRUE(hits(file, 0.05, {0.98, 0.98, 0.0})) << file;
  }
}

TEST(MeshFiles, ADoubleIsNotRoundedToFloat)
{
  // A sphere of 0.5 m at x = 0.49999999 reaches 0.99999999. As a float, 0.99999998 is 1.
  const TemporaryFolder folder;
  const std::string file = folder.write("a.obj", "v 0.99999998 -1 -1\nv 0.99999998 1 -1\nv 0.99999998 0 1\nf 1 2 3\n");
  auto same = std::make_shared<Mesh>();
  same->vertices = {{0.99999998, -1, -1}, {0.99999998, 1, -1}, {0.99999998, 0, 1}};
  same->triangles = {{0, 1, 2}};
  EXPECT_TRUE(hits(same, 0.5, {0.49999999, 0.0, 0.0}));
  EXPECT_TRUE(hits(file, 0.5, {0.49999999, 0.0, 0.0}));
  EXPECT_FALSE(hits(file, 0.5, {0.49999997, 0.0, 0.0}));
}

TEST(MeshFiles, ACubeIsTheSameInBinaryAndAsciiPly)
{
  const std::filesystem::path folder = std::filesystem::path(GPS_SHARED_DIR) / "cases";
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << "there is no " << folder;
  for (const char* name : {"silent.ply", "silent_ascii.ply", "cube_int.ply"})
  {
    const std::string file = (folder / name).string();
    EXPECT_TRUE(hits(file, 0.001, {0.015, 0.0, 0.0})) << name << ": inside the cube";
    EXPECT_TRUE(hits(file, 0.002, {0.021, 0.0, 0.0})) << name;
    EXPECT_FALSE(hits(file, 0.002, {0.023, 0.0, 0.0})) << name;
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
