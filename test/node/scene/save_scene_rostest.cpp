// save_scene.py writes the objects of a running node to a .scene file.

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "gpu_planning_scene/octomap.h"
#include "model/model_testing.h"
#include "node/messages/to_messages.h"
#include "node/node_client.h"

namespace gpu_planning_scene::core
{
namespace
{
class SaveScene : public RunningNode
{
 public:
  static int run(const std::string& arguments)
  {
    return std::system(("/usr/bin/python3 " GPS_SOURCE_DIR "/scripts/save_scene.py " + arguments).c_str());
  }

  static void addPrimitive(std::uint8_t type, const std::vector<double>& dimensions, CollisionObject& object)
  {
    object.primitives.emplace_back();
    object.primitives.back().type = type;
    object.primitives.back().dimensions.assign(dimensions.begin(), dimensions.end());
    object.primitive_poses.push_back(poseAt(Eigen::Vector3d(0.1, 0.2, 0.3)));
  }

  /// An object with every kind of shape, a subframe and a colour.
  static PlanningSceneMessage change()
  {
    using shape_msgs::SolidPrimitive;
    CollisionObject object = boxObject("big table", farAway(), 0.3);
    addPrimitive(SolidPrimitive::SPHERE, {0.1}, object);
    addPrimitive(SolidPrimitive::CYLINDER, {0.7, 0.1}, object);
    addPrimitive(SolidPrimitive::CONE, {0.6, 1.0 / 3.0}, object);
    object.meshes.resize(1);
    object.meshes[0].vertices.resize(3);
    object.meshes[0].vertices[1].x = 1.0 / 7.0;
    object.meshes[0].vertices[2].y = 1.0;
    object.meshes[0].triangles.resize(1);
    object.meshes[0].triangles[0].vertex_indices = {{0, 1, 2}};
    object.mesh_poses.push_back(poseAt(Eigen::Vector3d(0.0, 0.5, 0.0)));
    object.subframe_names.emplace_back("corner");
    object.subframe_poses.push_back(poseAt(Eigen::Vector3d(0.0, 0.0, 1.0)));
    CollisionObject floor;
    floor.id = "floor";
    floor.pose.orientation.w = 1.0;
    floor.planes.resize(1);
    floor.planes[0].coef = {{0.0, 0.0, 1.0, 50.0}};
    floor.plane_poses.push_back(poseAt(Eigen::Vector3d(0.0, 0.0, 0.0)));
    PlanningSceneMessage scene = diffWith(object);
    scene.world.collision_objects.push_back(floor);
    scene.object_colors.resize(1);
    scene.object_colors[0].id = "big table";
    scene.object_colors[0].color.r = 0.5F;
    scene.object_colors[0].color.a = 1.0F;
    return scene;
  }
};

TEST_F(SaveScene, TheFileHasTheSameObjects)
{
  apply(change());
  const TemporaryFolder folder;
  const std::string file = folder.path("saved.scene");
  ASSERT_EQ(0, run(file));
  const PlanningScene loaded = loadSceneFile(file, robot, {});
  const PlanningSceneMessage expected = scene();
  const PlanningSceneMessage found = messageOf(loaded, 0, {}, {});
  EXPECT_EQ(expected.world.collision_objects, found.world.collision_objects);
  EXPECT_EQ(expected.object_colors, found.object_colors);
}

TEST_F(SaveScene, TheOctomapAndCarriedObjectsAreNamedAsNotWritten)
{
  PlanningSceneMessage with_octomap = change();
  const SerializedOctree octree =
      octreeOf({{Box{Eigen::Vector3d::Constant(0.1)}, Eigen::Isometry3d(Eigen::Translation3d(0.05, 0.05, 0.05))}});
  Octomap& octomap = with_octomap.world.octomap.octomap;
  octomap.id = octree.id;
  octomap.binary = 1;
  octomap.resolution = octree.resolution;
  octomap.data = octree.bytes;
  with_octomap.world.octomap.origin = poseAt(farAway());
  AttachedCollisionObject carried;
  carried.link_name = tip;
  carried.object = boxObject("carried", Eigen::Vector3d(0.0, 0.0, 0.0), 0.01);
  carried.object.header.frame_id = tip;
  with_octomap.robot_state.attached_collision_objects = {carried};
  apply(with_octomap);
  const TemporaryFolder folder;
  const std::string file = folder.path("saved.scene");
  const std::string errors = folder.path("errors");
  ASSERT_EQ(0, run(file + " 2> " + errors));
  std::ostringstream said;
  said << std::ifstream(errors).rdbuf();
  EXPECT_NE(std::string::npos, said.str().find("not written, because the format has no octomaps: <octomap>"))
      << said.str();
  EXPECT_NE(std::string::npos, said.str().find("not written, because links carry them: carried")) << said.str();
  EXPECT_EQ(2U, loadSceneFile(file, robot, {}).objects.size());
}

TEST_F(SaveScene, ANameThatTheFormatCannotHoldIsAnError)
{
  PlanningSceneMessage with_space = change();
  with_space.world.collision_objects[0].subframe_names[0] = "left corner";
  apply(with_space);
  const TemporaryFolder folder;
  EXPECT_NE(0, run(folder.path("saved.scene")));
  EXPECT_NE(0, run(folder.path("saved.yaml")));
}
}  // namespace
}  // namespace gpu_planning_scene::core
