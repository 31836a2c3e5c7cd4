#include "model/real_robots.h"

#include <set>

#include <gtest/gtest.h>

#include "model/model_testing.h"

namespace gpu_planning_scene::core
{
namespace
{
std::size_t distinctMeshes(const RobotModel& robot)
{
  std::set<const Mesh*> meshes;
  for (const Link& link : robot.links())
  {
    for (const PlacedShape& placed : link.shapes)
      if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape))
        meshes.insert(mesh->get());
  }
  return meshes.size();
}

TEST(RealRobots, Kr5HasItsTrianglesAndJoints)
{
  SKIP_WITHOUT(kr5());
  std::vector<std::string> warnings;
  const auto robot = kr5().load(&warnings);
  EXPECT_EQ(robot->triangleCount(), 8730u);
  EXPECT_EQ(robot->variables().size(), 6u);
  EXPECT_EQ(robot->planningFrame(), "world");
  EXPECT_EQ(robot->adjacentLinks().size(), 6u);
  EXPECT_FALSE(robot->srdfCollisions().has_srdf);
  EXPECT_TRUE(warnings.empty()) << warnings[0];
}

TEST(RealRobots, WamsLinkNamesBeginWithASlash)
{
  SKIP_WITHOUT(wam());
  const auto robot = wam().load();
  EXPECT_EQ(robot->triangleCount(), 256u);
  EXPECT_EQ(robot->variables().size(), 7u);
  EXPECT_GE(robot->linkIndex("/wam7"), 0);
  EXPECT_EQ(robot->linkIndex("wam7"), -1);
}

TEST(RealRobots, WamsPackageIsNamedWhereItIsNotKnown)
{
  SKIP_WITHOUT(wam());
  RealRobot without_package = wam();
  without_package.packages.clear();
  const std::string error = errorOf([&] { without_package.load(); });
  EXPECT_NE(error.find("wam.urdf:13: link '/wam_base'"), std::string::npos) << error;
  EXPECT_NE(error.find("the folder of herb_description"), std::string::npos) << error;
}

TEST(RealRobots, DrchuboLoadsEqualMeshesOnce)
{
  SKIP_WITHOUT(drchubo());
  const auto robot = drchubo().load();
  EXPECT_EQ(robot->triangleCount(), 110368u);
  EXPECT_EQ(robot->links().size(), 52u);
  EXPECT_EQ(distinctMeshes(*robot), 37u);
  EXPECT_EQ(robot->adjacentLinks().size(), 51u);
}

TEST(RealRobots, Ur5RobotiqHasItsTrianglesAndGroups)
{
  SKIP_WITHOUT(ur5Robotiq());
  const auto robot = ur5Robotiq().load();
  EXPECT_EQ(robot->triangleCount(), 104185u);
  EXPECT_EQ(distinctMeshes(*robot), 13u);
  EXPECT_EQ(robot->variables().size(), 6u);
  EXPECT_TRUE(robot->srdfCollisions().has_srdf);
  EXPECT_EQ(robot->srdfCollisions().disabled.size(), 88u);

  const Group& arm = robot->group("manipulator");
  EXPECT_EQ(arm.variables, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  std::set<std::string> moved;
  for (const std::string& name : linkNames(*robot, arm.moved_links))
    moved.insert(name);
  EXPECT_EQ(moved.count("shoulder_link"), 1u);
  EXPECT_EQ(moved.count("robotiq_85_left_finger_link"), 1u) << "the gripper hangs on the arm";
  EXPECT_EQ(moved.count("base_link"), 0u);
  EXPECT_TRUE(robot->group("gripper").moved_links.empty()) << "its joints are fixed";
}
}  // namespace
}  // namespace gpu_planning_scene::core
