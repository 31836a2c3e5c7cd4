// MoveIt's parameter default_collision_operations. No ROS master is needed.

#include <gtest/gtest.h>

#include "gpu_planning_scene/cpu_checker.h"
#include "model/model_testing.h"
#include "node/parameters/collision_operations.h"
#include "scene/slider_robot.h"

namespace gpu_planning_scene::core
{
namespace
{
XmlRpc::XmlRpcValue operation(const std::string& object1, const std::string& object2, const std::string& name)
{
  XmlRpc::XmlRpcValue entry;
  entry["object1"] = object1;
  entry["object2"] = object2;
  entry["operation"] = name;
  return entry;
}

TEST(CollisionOperations, DisableAllowsContactAndEnableForbidsIt)
{
  PlanningScene scene = sliderAndWall();
  const auto isFreeAtTheWall = [&scene]
  {
    const std::vector<double> state = {1.0, 0.0};
    return CpuChecker(std::make_shared<const PlanningScene>(scene)).check(state.data(), 1, "").valid.at(0) != 0;
  };
  ASSERT_FALSE(isFreeAtTheWall());
  XmlRpc::XmlRpcValue operations;
  operations[0] = operation("cart", "wall", "disable");
  operations[1] = operation("pole", "wall", "disable");
  applyCollisionOperations(operations, "p", scene, nullptr);
  EXPECT_TRUE(isFreeAtTheWall());
  EXPECT_EQ(MatrixSource::SceneFile, scene.matrix_source) << "a whole scene must have this matrix";
  scene = sliderAndWall();
  XmlRpc::XmlRpcValue both;
  both[0] = operation("cart", "wall", "disable");
  both[1] = operation("pole", "wall", "disable");
  both[2] = operation("wall", "cart", "enable");
  applyCollisionOperations(both, "p", scene, nullptr);
  EXPECT_FALSE(isFreeAtTheWall());
}

TEST(CollisionOperations, AMatrixOfTheSceneFileCountsInstead)
{
  PlanningScene scene = sliderAndWall();
  scene.matrix_source = MatrixSource::SceneFile;
  const AllowedCollisionMatrix before = scene.allowed_collisions;
  XmlRpc::XmlRpcValue operations;
  operations[0] = operation("cart", "wall", "disable");
  std::vector<std::string> warnings;
  applyCollisionOperations(operations, "p", scene, &warnings);
  EXPECT_TRUE(before == scene.allowed_collisions);
  EXPECT_EQ(std::vector<std::string>{"parameter p is ignored, because the scene file has a matrix of its own"},
            warnings);
}

TEST(CollisionOperations, WrongValuesAreRefusedAndChangeNothing)
{
  PlanningScene scene = sliderAndWall();
  const AllowedCollisionMatrix before = scene.allowed_collisions;
  const auto refusal = [&](const XmlRpc::XmlRpcValue& value)
  { return errorOf([&] { applyCollisionOperations(value, "p", scene, nullptr); }); };
  EXPECT_EQ("parameter p is not a list of {object1: NAME, object2: NAME, operation: disable}",
            refusal(XmlRpc::XmlRpcValue("disable")));
  XmlRpc::XmlRpcValue operations;
  operations[0] = operation("cart", "wall", "disable");
  operations[1] = operation("cart", "wall", "forbid");
  EXPECT_EQ("parameter p: entry 1: the operation is 'forbid'; it must be disable or enable", refusal(operations));
  operations[1] = XmlRpc::XmlRpcValue("cart");
  EXPECT_EQ("parameter p: entry 1 has no text 'operation'; write {object1: NAME, object2: NAME, operation: disable}",
            refusal(operations));
  EXPECT_TRUE(before == scene.allowed_collisions);
}
}  // namespace
}  // namespace gpu_planning_scene::core
