#include "collision/trees/binned_sah.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

using Corner = std::function<Vector3d(std::mt19937_64&)>;

std::shared_ptr<const Mesh> soup(std::size_t triangles, const Corner& place, double size)
{
  std::mt19937_64 generator(5);
  std::normal_distribution<double> offset(0.0, size);
  auto mesh = std::make_shared<Mesh>();
  for (std::uint32_t t = 0; t < triangles; ++t)
  {
    const Vector3d center = place(generator);
    for (int i = 0; i < 3; ++i)
      mesh->vertices.push_back(center + Vector3d(offset(generator), offset(generator), offset(generator)));
    mesh->triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

Vector3d uniformPlace(std::mt19937_64& generator)
{
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  return {coordinate(generator), coordinate(generator), 1000.0 + coordinate(generator)};
}

/// Random places of which every halving of space leaves all but a few on one side.
Vector3d crowdedPlace(std::mt19937_64& generator)
{
  std::uniform_real_distribution<double> exponent(-250.0, 0.0);
  return {std::pow(10.0, exponent(generator)), 0.0, 0.0};
}

std::vector<Tessellation> meshes()
{
  return {{soup(1, uniformPlace, 0.01), 0.0},
          {soup(2, uniformPlace, 0.01), 0.0},
          {soup(3000, uniformPlace, 0.01), 0.0},
          {soup(
               1000, [](auto&) { return Vector3d(1, 2, 3); }, 0.0),
           0.0},
          {soup(2000, crowdedPlace, 0.0), 0.0},
          {soup(500, uniformPlace, 1.0), 0.0}};
}

class BinnedSah : public testing::Test
{
 protected:
  std::vector<Tessellation> meshes_ = meshes();
  Forest forest_ = buildBinnedSah(meshes_);

  /// Calls visit(node, depth) for every node of a tree.
  void visitTree(std::uint32_t root, const std::function<void(std::uint32_t, int)>& visit, int depth = 0) const
  {
    ASSERT_LT(root, forest_.nodes.size());
    ASSERT_LE(depth, 200);
    visit(root, depth);
    if (forest_.nodes[root].count == 0)
    {
      visitTree(forest_.nodes[root].first, visit, depth + 1);
      visitTree(forest_.nodes[root].first + 1, visit, depth + 1);
    }
  }

  std::vector<std::uint32_t> trianglesBelow(std::uint32_t root) const
  {
    std::vector<std::uint32_t> found;
    visitTree(root,
              [&](std::uint32_t index, int)
              {
                const Node& node = forest_.nodes[index];
                for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                  found.push_back(forest_.leaf_triangles[i]);
              });
    return found;
  }
};

TEST_F(BinnedSah, PutsEachTriangleInOneLeafOfItsOwnTree)
{
  std::uint32_t first = 0;
  for (std::size_t m = 0; m < meshes_.size(); ++m)
  {
    const auto count = static_cast<std::uint32_t>(meshes_[m].mesh->triangles.size());
    EXPECT_EQ(first, forest_.first_triangle[m]);
    std::vector<int> times(count, 0);
    for (const std::uint32_t triangle : trianglesBelow(forest_.roots[m]))
    {
      ASSERT_GE(triangle, first);
      ASSERT_LT(triangle, first + count);
      ++times[triangle - first];
    }
    EXPECT_EQ(std::vector<int>(count, 1), times) << "mesh " << m;
    first += count;
  }
}

TEST_F(BinnedSah, BoxesContainTheDoubleVerticesOfAllTrianglesBelow)
{
  for (std::size_t m = 0; m < meshes_.size(); ++m)
  {
    const Mesh& mesh = *meshes_[m].mesh;
    visitTree(forest_.roots[m],
              [&](std::uint32_t index, int depth)
              {
                if (depth > 20)
                  return;  // the crowded mesh is deep, and every level costs a traversal
                const Node& node = forest_.nodes[index];
                for (const std::uint32_t triangle : trianglesBelow(index))
                {
                  for (const std::uint32_t vertex : mesh.triangles[triangle - forest_.first_triangle[m]])
                  {
                    for (int axis = 0; axis < 3; ++axis)
                    {
                      const double center = node.center[axis];
                      ASSERT_LE(center - node.half[axis], mesh.vertices[vertex][axis]) << "mesh " << m;
                      ASSERT_GE(center + node.half[axis], mesh.vertices[vertex][axis]) << "mesh " << m;
                    }
                  }
                }
              });
  }
}

TEST_F(BinnedSah, DepthAndLeavesAreBounded)
{
  for (std::size_t m = 0; m < meshes_.size(); ++m)
  {
    const double bound = 64.0 + std::ceil(std::log2(static_cast<double>(meshes_[m].mesh->triangles.size()))) + 1.0;
    visitTree(forest_.roots[m],
              [&](std::uint32_t index, int depth)
              {
                EXPECT_LE(depth, bound) << "mesh " << m;
                EXPECT_LE(forest_.nodes[index].count, kLeafTriangles);
              });
  }
}

TEST_F(BinnedSah, SeparatesTwoClusters)
{
  const auto left_or_right = [](std::mt19937_64& generator) -> Vector3d
  {
    std::uniform_real_distribution<double> coordinate(-0.1, 0.1);
    return {(generator() % 2 == 0 ? -5.0 : 5.0) + coordinate(generator), coordinate(generator), coordinate(generator)};
  };
  const Forest forest = buildBinnedSah({{soup(1000, left_or_right, 0.01), 0.0}});
  const Node& root = forest.nodes[forest.roots[0]];
  ASSERT_EQ(0u, root.count);
  EXPECT_LT(forest.nodes[root.first].half[0], 0.2f);
  EXPECT_LT(forest.nodes[root.first + 1].half[0], 0.2f);
}
}  // namespace
}  // namespace gpu_planning_scene::core
