// Objects of the world, over apply_planning_scene: each operation and its effect on collisions of the robot's tip.

#include "model/model_testing.h"
#include "node/node_client.h"
#include "tools/run_program.h"

namespace gpu_planning_scene::core
{
namespace
{
using ObjectOperations = RunningNode;

TEST_F(ObjectOperations, ABoxIsAddedMovedAndRemoved)
{
  EXPECT_TRUE(isFree()) << "the state is free without objects";
  apply(diffWith(boxObject("box", tipPoint(), 0.02)));
  EXPECT_NE(std::string::npos, collision().find("box"));
  CollisionObject moved = objectOperation("box", CollisionObject::MOVE);
  moved.pose = poseAt(farAway());
  apply(diffWith(moved));
  EXPECT_TRUE(isFree());
  moved.pose = poseAt(tipPoint());
  apply(diffWith(moved));
  EXPECT_FALSE(isFree());
  apply(diffWith(objectOperation("box", CollisionObject::REMOVE)));
  EXPECT_TRUE(isFree());
}

TEST_F(ObjectOperations, AnAddReplacesTheObjectOfThatName)
{
  apply(diffWith(boxObject("box", tipPoint(), 0.02)));
  apply(diffWith(boxObject("box", farAway(), 0.02)));
  EXPECT_TRUE(isFree());
  EXPECT_EQ(1u, scene().world.collision_objects.size());
}

TEST_F(ObjectOperations, AShapeOfAnotherSizeCollides)
{
  const Eigen::Vector3d above = tipPoint() + Eigen::Vector3d(0.0, 0.0, 5.0);
  apply(diffWith(boxObject("box", above, 0.1)));
  EXPECT_TRUE(isFree());
  apply(diffWith(boxObject("box", above, 10.5)));
  EXPECT_FALSE(isFree());
  apply(diffWith(boxObject("box", above, 0.1)));
  EXPECT_TRUE(isFree());
}

TEST_F(ObjectOperations, AnAppendAddsShapes)
{
  apply(diffWith(boxObject("box", farAway(), 0.02)));
  EXPECT_TRUE(isFree());
  CollisionObject more = boxObject("box", farAway(), 0.02);
  more.operation = CollisionObject::APPEND;
  more.primitive_poses[0] = poseAt(Eigen::Vector3d(tipPoint() - farAway()));
  apply(diffWith(more));
  EXPECT_FALSE(isFree());
  EXPECT_EQ(2u, scene().world.collision_objects.at(0).primitives.size());
}

TEST_F(ObjectOperations, AMoveMayPlaceTheShapesAnew)
{
  apply(diffWith(boxObject("box", farAway(), 0.02)));
  CollisionObject moved = objectOperation("box", CollisionObject::MOVE);
  moved.pose = poseAt(farAway());
  moved.primitive_poses.push_back(poseAt(Eigen::Vector3d(tipPoint() - farAway())));
  apply(diffWith(moved));
  EXPECT_FALSE(isFree());
  moved.primitive_poses.push_back(moved.primitive_poses.front());
  expectRefusal(diffWith(moved), "box");
}

TEST_F(ObjectOperations, ARemoveWithoutANameRemovesAll)
{
  for (const char* id : {"a", "b", "c"})
    apply(diffWith(boxObject(id, tipPoint(), 0.02)));
  apply(diffWith(objectOperation("", CollisionObject::REMOVE)));
  EXPECT_TRUE(isFree());
  EXPECT_TRUE(scene().world.collision_objects.empty());
}

TEST_F(ObjectOperations, AMeshIsAnObstacleWhereItIsMovedTo)
{
  CollisionObject mesh = objectOperation("mesh", CollisionObject::ADD);
  mesh.pose = poseAt(farAway());
  mesh.meshes.resize(1);
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(-0.05, -0.05, -0.05), Eigen::Vector3d(0.1, 0.0, -0.05),
                                        Eigen::Vector3d(0.0, 0.1, -0.05), Eigen::Vector3d(0.0, 0.0, 0.1)})
    mesh.meshes[0].vertices.push_back(poseAt(corner).position);
  mesh.meshes[0].triangles.resize(4);
  mesh.meshes[0].triangles[0].vertex_indices = {{0, 2, 1}};
  mesh.meshes[0].triangles[1].vertex_indices = {{0, 1, 3}};
  mesh.meshes[0].triangles[2].vertex_indices = {{1, 2, 3}};
  mesh.meshes[0].triangles[3].vertex_indices = {{2, 0, 3}};
  apply(diffWith(mesh));
  EXPECT_TRUE(isFree());
  CollisionObject moved = objectOperation("mesh", CollisionObject::MOVE);
  moved.pose = poseAt(tipPoint());
  apply(diffWith(moved));
  EXPECT_FALSE(isFree());
}

TEST_F(ObjectOperations, APlanesSolidIsTheHalfSpaceBehindIt)
{
  CollisionObject plane = objectOperation("plane", CollisionObject::ADD);
  plane.planes.resize(1);
  plane.planes[0].coef = {{0.0, 0.0, 1.0, 100.0}};  // the plane z = -100
  apply(diffWith(plane));
  EXPECT_TRUE(isFree());
  plane.planes[0].coef = {{0.0, 0.0, 1.0, -tipPoint().z() - 0.001}};
  apply(diffWith(plane));
  EXPECT_FALSE(isFree());
}

TEST_F(ObjectOperations, TenThousandBoxesAreAddedAtOnce)
{
  PlanningSceneMessage change = diffScene();
  for (int i = 0; i < 10000; ++i)
    change.world.collision_objects.push_back(
        boxObject("box " + std::to_string(i), farAway() + Eigen::Vector3d(i, 0.0, 0.0), 0.02));
  apply(change);
  EXPECT_TRUE(isFree());
  EXPECT_EQ(10000u, scene(PlanningSceneComponents::WORLD_OBJECT_NAMES).world.collision_objects.size());
  CollisionObject moved = objectOperation("box 5000", CollisionObject::MOVE);
  moved.pose = poseAt(tipPoint());
  apply(diffWith(moved));
  EXPECT_NE(std::string::npos, collision().find("box 5000"));
}

TEST_F(ObjectOperations, AMeshFileIsAddedFromTheCommandLine)
{
  const TemporaryFolder folder;
  const std::string file = folder.write("tetrahedron.obj",
                                        "v 0.02 0.02 0.02\nv 0.02 -0.02 -0.02\nv -0.02 0.02 -0.02\nv -0.02 -0.02 0.02\n"
                                        "f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n");
  const auto add = [&](const Eigen::Vector3d& at, const std::string& frame)
  {
    const std::string place = std::to_string(at.x()) + "," + std::to_string(at.y()) + "," + std::to_string(at.z());
    return runProgram(GPS_ADD_OBJECT, {"--object", "tetrahedron=" + file + "," + place, "--frame", frame});
  };
  EXPECT_EQ(0, add(farAway(), "").exit_code);
  EXPECT_TRUE(isFree());
  const ProgramOutput added = add(linkPose(tip, free_state).inverse() * tipPoint(), tip);
  EXPECT_EQ(0, added.exit_code) << added.err;
  EXPECT_NE(std::string::npos, collision().find("tetrahedron"));
  const ProgramOutput refused = add(farAway(), "no such frame");
  EXPECT_EQ(1, refused.exit_code);
  EXPECT_NE(std::string::npos, refused.err.find("no such frame")) << refused.err;
}

TEST_F(ObjectOperations, WrongChangesAreRefusedAndChangeNothing)
{
  apply(diffWith(boxObject("box", farAway(), 0.02)));
  expectRefusal(diffWith(objectOperation("no such object", CollisionObject::REMOVE)), "no such object");
  CollisionObject moved = objectOperation("no such object", CollisionObject::MOVE);
  moved.pose = poseAt(farAway());
  expectRefusal(diffWith(moved), "no such object");
  expectRefusal(diffWith(objectOperation("shapeless", CollisionObject::ADD)), "shapeless");
  expectRefusal(diffWith(boxObject(tip, farAway(), 0.02)), tip);
  expectRefusal(diffWith(boxObject("flat", farAway(), -1.0)), "flat");
  expectRefusal(diffWith(objectOperation("box", 7)), "7");
  PlanningSceneMessage half_right = diffWith(boxObject("right", farAway(), 0.02));
  half_right.world.collision_objects.push_back(objectOperation("wrong", CollisionObject::REMOVE));
  expectRefusal(half_right, "wrong");
}
}  // namespace
}  // namespace gpu_planning_scene::core
