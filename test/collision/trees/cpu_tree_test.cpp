#include "collision/trees/cpu_tree.h"

#include <thread>

#include <gtest/gtest.h>

namespace gpu_planning_scene::core
{
namespace
{
std::shared_ptr<const CpuTree> treeOf(const Shape& shape)
{
  return cpuTreeOf(shape, tessellate(shape));
}

TEST(CpuTrees, OfEqualShapesAreOneTreeWhileItIsInUse)
{
  const Shape mesh(std::make_shared<const Mesh>(*tessellate(Sphere{0.1}).mesh));
  const Shape equal_mesh(std::make_shared<const Mesh>(*tessellate(Sphere{0.1}).mesh));
  const auto ball = treeOf(mesh);
  EXPECT_EQ(ball, treeOf(mesh));
  EXPECT_NE(ball, treeOf(equal_mesh)) << "meshes are compared by address";
  const auto box = treeOf(Box{{0.1, 0.2, 0.3}});
  EXPECT_EQ(box, treeOf(Box{{0.1, 0.2, 0.3}}));
  EXPECT_NE(box, treeOf(Box{{0.1, 0.3, 0.2}}));
  EXPECT_NE(box, treeOf(Cylinder{0.05, 0.3}));
}

TEST(CpuTrees, AreNotKeptWhenTheyAreNoLongerInUse)
{
  auto mesh = std::make_shared<const Mesh>(*tessellate(Sphere{0.1}).mesh);
  const std::weak_ptr<const Mesh> watched = mesh;
  std::weak_ptr<const CpuTree> tree = treeOf(mesh);
  EXPECT_TRUE(tree.expired());
  mesh.reset();
  EXPECT_TRUE(watched.expired());
}

TEST(CpuTrees, HoldTheirMeshSoThatNoOtherMeshTakesItsAddress)
{
  auto mesh = std::make_shared<const Mesh>(*tessellate(Sphere{0.1}).mesh);
  const std::weak_ptr<const Mesh> watched = mesh;
  const auto tree = treeOf(mesh);
  mesh.reset();
  EXPECT_FALSE(watched.expired());
}

TEST(CpuTrees, OfManyShapesAreBuiltAndDroppedBySeveralThreads)
{
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back(
        []
        {
          for (int i = 0; i < 1500; ++i)
          {
            const Box box{{0.1, 0.1, 0.001 * (1 + i)}};
            EXPECT_EQ(box.size, std::get<Box>(treeOf(box)->shape).size);
          }
        });
  for (std::thread& thread : threads)
    thread.join();
}
}  // namespace
}  // namespace gpu_planning_scene::core
