#include "collision/exact/exact_checker.h"

#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "collision/geometry/primitive_solid.h"
#include "support/inside.h"
#include "support/moving_shape.h"
#include "support/obstacles.h"
#include "support/repetitions.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

Triangle triangleOf(const Mesh& mesh, std::size_t t, const Isometry3d& pose)
{
  const auto& corners = mesh.triangles[t];
  return {pose * mesh.vertices[corners[0]], pose * mesh.vertices[corners[1]], pose * mesh.vertices[corners[2]]};
}

/// Tests every triangle and primitive against every other.
bool collideByBruteForce(const Shape& a, const Tessellation& surface_a, const Shape& b, const Tessellation& surface_b,
                         const Isometry3d& b_in_a)
{
  const Isometry3d a_in_b = b_in_a.inverse();
  for (std::size_t i = 0; i < surface_a.mesh->triangles.size(); ++i)
  {
    const Triangle in_b = triangleOf(*surface_a.mesh, i, a_in_b);
    if (!isMesh(b))
    {
      if (triangleWithinSolid(in_b, b, 0.0))
        return true;
      continue;
    }
    for (std::size_t j = 0; j < surface_b.mesh->triangles.size(); ++j)
      if (trianglesWithin(in_b, triangleOf(*surface_b.mesh, j, Isometry3d::Identity()), 0.0))
        return true;
  }
  // One body may contain the other one.
  return !isMesh(a) && (isMesh(b) ? hasVertexInside(*surface_b.mesh, b_in_a, a) : isInside(a, b_in_a.translation()));
}

/// A mesh that does not contain its frame's origin.
std::shared_ptr<const Mesh> offCenter(const Mesh& mesh)
{
  auto moved = std::make_shared<Mesh>(mesh);
  for (Vector3d& vertex : moved->vertices)
    vertex += Vector3d(0.1, 0.05, -0.1);
  return moved;
}

std::vector<Shape> allKinds()
{
  return {Box{{0.2, 0.1, 0.05}}, Sphere{0.06},         Cylinder{0.05, 0.2},
          Cone{0.1, 0.15},       torusMesh(0.1, 0.04), offCenter(*sheetMesh(0.2))};
}

TEST(ExactChecker, FindsWhatTestingEverythingFindsForAllKindsOfShapes)
{
  const std::uint64_t seed = 1;
  std::mt19937_64 generator(seed);
  for (const Shape& a : allKinds())
  {
    for (const Shape& b : allKinds())
    {
      MovingShape pairs(a, {{b, Isometry3d::Identity()}});
      int hits = 0;
      const int poses = isMesh(a) && isMesh(b) ? repetitions(15, 30) : repetitions(30, 60);
      for (int i = 0; i < poses; ++i)
      {
        const Isometry3d pose = randomPose(generator, isMesh(a) && isMesh(b) ? 0.18 : 0.12);
        const bool expected = isMesh(a) || !isMesh(b)
                                  ? collideByBruteForce(a, pairs.trees()[0], b, pairs.trees()[1], pose.inverse())
                                  : collideByBruteForce(b, pairs.trees()[1], a, pairs.trees()[0], pose);
        hits += expected;
        ASSERT_EQ(expected, pairs.collides(pose))
            << "seed " << seed << ", kinds " << a.index() << " and " << b.index() << ", pose " << i;
      }
      EXPECT_GT(hits, 0) << a.index() << " and " << b.index();
      EXPECT_LT(hits, poses) << a.index() << " and " << b.index();
    }
  }
}

/// A shape approaches until it touches. The boxes of the nodes in contact then touch too.
TEST(ExactChecker, FindsWhatTestingEverythingFindsNearContact)
{
  const std::uint64_t seed = 4;
  std::mt19937_64 generator(seed);
  const Shape still = offCenter(*sheetMesh(0.2));
  for (const Shape& moving : {Shape(torusMesh(0.1, 0.04)), Shape(Box{{0.2, 0.1, 0.05}}), Shape(Cylinder{0.05, 0.2})})
  {
    MovingShape pairs(moving, {{still, Isometry3d::Identity()}});
    for (int i = 0; i < 5; ++i)
    {
      Isometry3d pose = randomPose(generator, 0.0);
      const auto at = [&pose](double height)
      {
        pose.translation() = Vector3d(0.11, 0.04, height);
        return pose;
      };
      double free = 2.0;
      double hit = -0.1;  // at the height of the sheet
      ASSERT_TRUE(pairs.collides(at(hit)) && !pairs.collides(at(free)));
      while (free - hit > 1e-10)
      {
        const double middle = 0.5 * (free + hit);
        (pairs.collides(at(middle)) ? hit : free) = middle;
      }
      for (const double distance : {-1e-5, -1e-8, -1e-9, 1e-9, 1e-8, 1e-5})
      {
        const Isometry3d placed = at(hit + distance);
        const bool expected = collideByBruteForce(still, pairs.trees()[1], moving, pairs.trees()[0], placed);
        ASSERT_EQ(expected, pairs.collides(placed))
            << "seed " << seed << ", kind " << moving.index() << ", pose " << i << ", distance " << distance;
      }
    }
  }
}

/// A valid but inefficient tree: triangles are split at a third in their given order, and all nodes have the same box,
/// which is too large.
Forest buildCarelessly(const std::vector<Tessellation>& meshes)
{
  Forest forest;
  std::uint32_t first_triangle = 0;
  for (const Tessellation& tessellation : meshes)
  {
    const auto count = static_cast<std::uint32_t>(tessellation.mesh->triangles.size());
    Eigen::AlignedBox3d box;
    for (const Vector3d& vertex : tessellation.mesh->vertices)
      box.extend(vertex);
    const Vector3d c = box.center();
    const Vector3d h = 0.51 * box.sizes() + Vector3d::Constant(1e-3);
    const auto fill = [&](std::uint32_t first, std::uint32_t n)
    {
      return Node{{static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z())},
                  first,
                  {static_cast<float>(h.x()), static_cast<float>(h.y()), static_cast<float>(h.z())},
                  n};
    };
    const std::function<void(std::uint32_t, std::uint32_t, std::uint32_t)> build =
        [&](std::uint32_t node, std::uint32_t begin, std::uint32_t end)
    {
      if (end - begin <= kLeafTriangles)
      {
        forest.nodes[node] = fill(begin, end - begin);
        return;
      }
      const auto child = static_cast<std::uint32_t>(forest.nodes.size());
      forest.nodes[node] = fill(child, 0);
      forest.nodes.resize(child + 2);
      const std::uint32_t middle = begin + (end - begin) / 3;
      build(child, begin, middle == begin ? begin + 1 : middle);
      build(child + 1, middle == begin ? begin + 1 : middle, end);
    };
    forest.roots.push_back(static_cast<std::uint32_t>(forest.nodes.size()));
    forest.first_triangle.push_back(first_triangle);
    forest.nodes.emplace_back();
    for (std::uint32_t t = 0; t < count; ++t)
      forest.leaf_triangles.push_back(first_triangle + t);
    build(forest.roots.back(), first_triangle, first_triangle + count);
    first_triangle += count;
  }
  return forest;
}

TEST(ExactChecker, AnswersTheSameForAnyValidTree)
{
  const std::uint64_t seed = 2;
  std::mt19937_64 generator(seed);
  const Shape torus = torusMesh(0.1, 0.04);
  MovingShape good(torus, {{torus, Isometry3d::Identity()}});
  MovingShape careless(torus, {{torus, Isometry3d::Identity()}}, {}, buildCarelessly);
  for (int i = 0; i < 20; ++i)
  {
    const Isometry3d pose = randomPose(generator, 0.15);
    ASSERT_EQ(good.collides(pose), careless.collides(pose)) << "seed " << seed << ", pose " << i;
  }
}

TEST(ExactChecker, TouchingCollidesAndANanometreOfClearanceDoesNot)
{
  const Box table{{1.0, 1.0, 0.05}};
  for (const Shape& shape : {Shape(Box{{0.1, 0.1, 0.2}}), Shape(Sphere{0.1}), Shape(Cylinder{0.05, 0.2}),
                             Shape(Cone{0.05, 0.2}), Shape(tessellate(Box{{0.1, 0.1, 0.2}}).mesh)})
  {
    for (const double distance : {0.0, 100.0})
    {
      MovingShape pairs(shape, {{table, at(distance, 0.0, 0.0)}});
      EXPECT_TRUE(pairs.collides(at(distance, 0.3, 0.125))) << shape.index();
      EXPECT_FALSE(pairs.collides(at(distance, 0.3, 0.125 + 1e-9))) << shape.index();
      EXPECT_TRUE(pairs.collides(at(distance, 0.3, 0.125 - 1e-9))) << shape.index();
    }
  }
}

TEST(ExactChecker, ShapesInsideAPrimitiveCollide)
{
  for (const Shape& small : {Shape(Box{{0.01, 0.01, 0.01}}), Shape(Sphere{0.01}), Shape(Cylinder{0.01, 0.02}),
                             Shape(Cone{0.01, 0.02}), Shape(torusMesh(0.01, 0.002))})
  {
    for (const Shape& large :
         {Shape(Box{{1.0, 1.0, 1.0}}), Shape(Sphere{0.5}), Shape(Cylinder{0.5, 1.0}), Shape(Cone{0.5, 1.0})})
    {
      EXPECT_TRUE(MovingShape(small, {{large, Isometry3d::Identity()}}).collides(at(0.02, 0.03, 0.1)))
          << small.index() << " in " << large.index();
      EXPECT_TRUE(MovingShape(large, {{small, Isometry3d::Identity()}}).collides(at(-0.02, -0.03, -0.1)))
          << small.index() << " in " << large.index();
    }
  }
}

TEST(ExactChecker, FindsEveryObjectThatCollidesAmongHundreds)
{
  const std::uint64_t seed = 3;
  std::mt19937_64 generator(seed);
  std::vector<PlacedShape> objects;
  for (int i = 0; i < 500; ++i)
    objects.push_back({Box{{0.05, 0.1, 0.15}}, randomPose(generator, 1.0)});
  const Box moving{{0.3, 0.4, 0.5}};
  MovingShape pairs(moving, objects);
  for (int i = 0; i < 20; ++i)
  {
    const Isometry3d pose = randomPose(generator, 1.0);
    std::vector<BodyPair> expected;
    for (std::size_t k = 0; k < objects.size(); ++k)
      if (collideByBruteForce(moving, pairs.trees()[0], objects[k].shape, pairs.trees()[k + 1],
                              pose.inverse() * objects[k].pose))
        expected.push_back({0, static_cast<std::int32_t>(k + 1)});
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(expected, pairs.all(pose)) << "seed " << seed << ", pose " << i;
    EXPECT_TRUE(pairs.collides(pose));
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
