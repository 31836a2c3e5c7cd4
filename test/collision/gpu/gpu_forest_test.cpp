// Trees that the GPU builds are valid for any triangles, and almost as good as trees of the binned SAH build on the
// CPU.

#include <cmath>
#include <functional>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "collision/gpu/problem/gpu_scene.h"
#include "collision/trees/binned_sah.h"
#include "gpu/egl_context.h"
#include "gpu_planning_scene/error.h"
#include "shader_constants.h"
#include "support/test_scenes.h"
#include "support/traversal_cost.h"
#include "support/triangle_soup.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

/// Meshes that are difficult for a tree builder, ordinary meshes, and single triangles between them.
std::vector<std::shared_ptr<const Mesh>> hardMeshes()
{
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto anywhere = [&] { return Vector3d(uniform(generator), uniform(generator), uniform(generator)); };
  std::uint32_t count = 0;
  const auto spiral = [&]
  {
    const double at = 0.0003 * count++;
    return Vector3d(std::cos(at), std::sin(at), 0.1 * at + 0.001 * uniform(generator));
  };
  const auto exponential = [&] { return Vector3d(std::pow(2.0, -120.0 * std::abs(uniform(generator))), 0.0, 0.0); };
  return {
      triangleSoup(1, anywhere),       triangleSoup(2, anywhere),
      triangleSoup(20000, spiral),     triangleSoup(5000, [] { return Vector3d(1, 2, 3); }),   // all alike, all points
      triangleSoup(3000, exponential),                               // every halving leaves all but a few on one side
      triangleSoup(1, anywhere),       triangleSoup(500, anywhere),  // all overlap
      tessellate(Sphere{0.3}).mesh};
}

class GpuForest : public testing::Test
{
 protected:
  Forest build(const std::vector<std::shared_ptr<const Mesh>>& robot,
               const std::vector<std::shared_ptr<const Mesh>>& world)
  {
    problem_ = {};
    for (const auto* meshes : {&robot, &world})
      for (const auto& mesh : *meshes)
      {
        problem_.tessellations.push_back(tessellate(mesh));
        problem_.shapes.emplace_back(mesh);
        auto& instances = meshes == &robot ? problem_.robot : problem_.world;
        instances.push_back(
            {static_cast<std::uint32_t>(problem_.tessellations.size() - 1), 0, 0, Eigen::Isometry3d::Identity()});
      }
    problem_.world_pairs.assign(robot.size() * world.size(), 1);
    scene_.setProblem(problem_);
    return scene_.readForest();
  }

  /// Expects that every triangle of the mesh is in exactly one leaf, that nodes contain the triangles below them, and
  /// that the depth is bounded.
  void expectValid(const Forest& forest, std::size_t tree)
  {
    const Mesh& mesh = *problem_.tessellations[tree].mesh;
    std::vector<int> seen(mesh.triangles.size(), 0);
    std::size_t deepest = 0;
    const std::function<void(std::uint32_t, std::size_t, std::vector<std::uint32_t>)> visit =
        [&](std::uint32_t index, std::size_t depth, std::vector<std::uint32_t> ancestors)
    {
      ASSERT_LT(index, forest.nodes.size());
      ASSERT_LE(depth, std::size_t{BUILD_ROUNDS});
      deepest = std::max(deepest, depth);
      const Node& node = forest.nodes[index];
      ancestors.push_back(index);
      if (node.count == 0)
      {
        visit(node.first, depth + 1, ancestors);
        visit(node.first + 1, depth + 1, ancestors);
        return;
      }
      ASSERT_LE(node.count, std::uint32_t{LEAF_TRIANGLES});
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      {
        const std::uint32_t triangle = forest.leaf_triangles[i] - forest.first_triangle[tree];
        ASSERT_LT(triangle, mesh.triangles.size());
        ++seen[triangle];
        for (const std::uint32_t corner : mesh.triangles[triangle])
          for (const std::uint32_t ancestor : ancestors)
            for (int axis = 0; axis < 3; ++axis)
            {
              const Node& box = forest.nodes[ancestor];
              const auto coordinate = static_cast<std::size_t>(axis);
              ASSERT_LE(std::abs(mesh.vertices[corner][axis] - double{box.center[coordinate]}),
                        double{box.half[coordinate]});
            }
      }
    };
    visit(forest.roots[tree], 0, {});
    for (const int times : seen)
      ASSERT_EQ(times, 1);
    EXPECT_LE(deepest, scene_.depthBound());
  }

  EglContext context_{"auto"};
  GpuScene scene_{shaderFolder()};
  CollisionProblem problem_;
};

TEST_F(GpuForest, HoldsEveryTriangleOnceInBoxesThatContainIt)
{
  const auto meshes = hardMeshes();
  const Forest forest = build({meshes.begin(), meshes.begin() + 4}, {meshes.begin() + 4, meshes.end()});
  for (std::size_t tree = 0; tree < meshes.size(); ++tree)
    expectValid(forest, tree);
}

TEST_F(GpuForest, IsRebuiltForAnotherWorldAndKeepsTheRobotsTrees)
{
  const auto meshes = hardMeshes();
  build({meshes[2], meshes[6]}, {meshes[0]});
  const Forest forest = build({meshes[2], meshes[6]}, {meshes[4], meshes[7], meshes[1]});
  for (std::size_t tree = 0; tree < 5; ++tree)
    expectValid(forest, tree);
}

TEST_F(GpuForest, RefusesCoordinatesThatDoNotFitIntoFloats)
{
  auto far = std::make_shared<Mesh>();
  far->name = "far.stl";
  far->vertices = {{0, 0, 0}, {1e30, 0, 0}, {0, 1, 0}};
  far->triangles = {{0, 1, 2}};
  try
  {
    build({far}, {});
    FAIL() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("far.stl"), std::string::npos) << error.what();
  }
}

/// Compares the cost of traversals in random poses near contact, for trees of the GPU and of the CPU's binned SAH
/// build.
TEST_F(GpuForest, CostsAtMostFifteenPercentMoreToTraverseThanBinnedSah)
{
  std::vector<std::shared_ptr<const Mesh>> meshes = {hardMeshes()[2], tessellate(Sphere{0.3}).mesh};
  for (const std::string name : {"kr5", "drchubo", "ur5_cage"})
  {
    if (const std::string missing = missingFor(name); !missing.empty())
    {
      std::cout << "without " << name << ": there is no " << missing << std::endl;
      continue;
    }
    const auto robot = loadRobotOf(name);
    for (const Link& link : robot->links())
      for (const PlacedShape& placed : link.shapes)
        if (const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&placed.shape))
          meshes.push_back(*mesh);
  }
  const Forest gpu = build(meshes, {});
  const Forest sah = buildBinnedSah(problem_.tessellations);
  const std::uint64_t seed = 3;
  double gpu_cost = 0.0;
  double sah_cost = 0.0;
  for (std::size_t a = 0; a < meshes.size(); ++a)
  {
    const std::size_t b = (a + 1) % meshes.size();
    gpu_cost += traversalCost(gpu, problem_.tessellations, a, b, seed);
    sah_cost += traversalCost(sah, problem_.tessellations, a, b, seed);
  }
  std::cout << meshes.size() << " meshes, seed " << seed << ": cost " << gpu_cost / sah_cost << " of binned SAH's"
            << std::endl;
  EXPECT_LE(gpu_cost, 1.15 * sah_cost);
}
}  // namespace
}  // namespace gpu_planning_scene::core
