// The balls of a cover enclose and fill their shape, for primitives, meshes with and without a solid, and real links.

#include <random>

#include <gtest/gtest.h>

#include "collision/exact/winding_number.h"
#include "collision/geometry/primitive_solid.h"
#include "collision/geometry/triangle_pair.h"
#include "collision/proofs/ball_cover.h"
#include "collision/proofs/shape_samples.h"
#include "support/repetitions.h"
#include "support/seed.h"
#include "support/test_scenes.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;

using NamedShape = std::pair<std::string, Shape>;

struct Covered
{
  std::string name;
  std::shared_ptr<const CpuTree> tree;
  BallCover cover;
  double sagitta;
};

std::shared_ptr<const Mesh> withoutSomeTriangles(const Shape& shape)
{
  auto mesh = std::make_shared<Mesh>(*tessellate(shape).mesh);
  mesh->triangles.resize(mesh->triangles.size() * 4 / 5);
  return mesh;
}

std::vector<NamedShape> shapes()
{
  std::vector<NamedShape> all = {{"box", Box{{0.3, 0.2, 0.1}}},
                                 {"plate", Box{{0.3, 0.2, 0.002}}},
                                 {"ball", Sphere{0.1}},
                                 {"cylinder", Cylinder{0.05, 0.4}},
                                 {"cone", Cone{0.1, 0.2}},
                                 {"disc of a watch", Cylinder{0.005, 0.0005}},
                                 {"pin", Cylinder{0.001, 0.002}},
                                 {"mesh of a box", tessellate(Box{{0.3, 0.2, 0.1}}).mesh},
                                 {"mesh of a ball", tessellate(Sphere{0.1}).mesh},
                                 {"open mesh", withoutSomeTriangles(Cylinder{0.05, 0.4})}};
  for (const char* name : {"kr5"})
    if (missingFor(name).empty())
      for (const Link& link : testScene(name).scene->robot->links())
        for (const PlacedShape& placed : link.shapes)
          all.push_back({std::string(name) + " " + link.name, placed.shape});
  return all;
}

/// All shapes with their covers, which are made once.
const std::vector<Covered>& coveredShapes()
{
  static const std::vector<Covered> covered = []
  {
    std::vector<Covered> made;
    for (const auto& [name, shape] : shapes())
    {
      const Tessellation tessellation = tessellate(shape);
      const auto tree = cpuTreeOf(shape, tessellation);
      made.push_back({name, tree, coverOf(*tree, samplesOf(*tree), tessellation.sagitta), tessellation.sagitta});
    }
    return made;
  }();
  return covered;
}

bool isIn(const Vector3d& point, const std::vector<CoverBall>& balls)
{
  return std::any_of(
      balls.begin(), balls.end(),
      [&point](const CoverBall& ball) { return (ball.center - point).norm() <= ball.outer; });
}

/// A random point of a triangle.
Vector3d pointOf(const Triangle& triangle, std::mt19937_64& generator)
{
  std::uniform_real_distribution<double> share(0.0, 1.0);
  double a = share(generator);
  double b = share(generator);
  if (a + b > 1.0)
  {
    a = 1.0 - a;
    b = 1.0 - b;
  }
  return triangle[0] + a * (triangle[1] - triangle[0]) + b * (triangle[2] - triangle[0]);
}

Vector3d direction(std::mt19937_64& generator)
{
  std::normal_distribution<double> normal;
  return Vector3d(normal(generator), normal(generator), normal(generator)).normalized();
}

class BallCoverTest : public testing::Test
{
 protected:
  template <class Test>
  void forEachShape(const Test& test)
  {
    for (const Covered& covered : coveredShapes())
    {
      SCOPED_TRACE(covered.name + ", seed " + std::to_string(kSeed));
      test(*covered.tree, covered.cover, covered.sagitta);
      if (HasFatalFailure())
        return;
    }
  }

  std::mt19937_64 generator_{kSeed};
};

TEST_F(BallCoverTest, EachPointOfTheSurfaceIsInABallOfEachLevel)
{
  forEachShape(
      [this](const CpuTree& tree, const BallCover& cover, double sagitta)
      {
        for (const auto& level : cover.levels)
        {
          ASSERT_FALSE(level.empty());
          for (int i = 0; i < repetitions(700, 20000); ++i)
          {
            const Triangle& triangle = tree.triangles[generator_() % tree.triangles.size()];
            // The true surface of a curved primitive is up to the sagitta away from its triangles.
            const Vector3d point = pointOf(triangle, generator_) + sagitta * direction(generator_);
            ASSERT_TRUE(isIn(point, level)) << level.size() << " balls";
          }
        }
      });
}

TEST_F(BallCoverTest, PointsOfTheSolidBelowTheLayerAreInABall)
{
  forEachShape(
      [this](const CpuTree& tree, const BallCover& cover, double)
      {
        if (!hasSolid(tree))
          return;
        std::size_t deep = 0;
        for (int i = 0; i < 3000; ++i)
        {
          const Vector3d share = 0.5 * (Vector3d::Ones() + Vector3d::Random());
          const Vector3d point = tree.center + (2.0 * share - Vector3d::Ones()).cwiseProduct(tree.half);
          if (!insideSolid(tree, point) || distanceFromSurface(tree, point) <= cover.layer)
            continue;
          ++deep;
          for (const auto& level : cover.levels)
            ASSERT_TRUE(isIn(point, level)) << level.size() << " balls";
        }
        std::cout << deep << " points below the layer of " << cover.layer << " m" << std::endl;
      });
}

TEST_F(BallCoverTest, CellsOfTheSolidAreInsideIt)
{
  for (const Covered& covered : coveredShapes())
  {
    const ShapeSamples samples = samplesOf(*covered.tree);
    for (const SolidCell& cell : samples.cells)
      ASSERT_TRUE(insideSolid(*covered.tree, cell.center)) << covered.name << ", " << cell.center.transpose();
  }
}

TEST_F(BallCoverTest, InnerBallsAreInTheShape)
{
  forEachShape(
      [this](const CpuTree& tree, const BallCover& cover, double)
      {
        for (const auto& level : cover.levels)
          for (const CoverBall& ball : level)
          {
            ASSERT_GE(ball.inner, 0.0);
            if (ball.inner == 0.0)
            {
              ASSERT_LT(distanceFromSurface(tree, ball.witness), 1e-9) << "the witness is on the surface";
              continue;
            }
            for (int i = 0; i < 20; ++i)
              ASSERT_TRUE(insideSolid(tree, ball.witness + 0.999999 * ball.inner * direction(generator_)));
          }
      });
}

/// A surface of long slivers would need millions of small pieces.
TEST_F(BallCoverTest, SliversAreCutIntoALimitedNumberOfPieces)
{
  auto tube = std::make_shared<Mesh>();
  constexpr unsigned kFacets = 2000;
  for (unsigned i = 0; i < kFacets; ++i)
  {
    const double angle = 2.0 * EIGEN_PI * i / kFacets;
    for (const double x : {0.0, 1.0})
      tube->vertices.emplace_back(x, 0.05 * std::cos(angle), 0.05 * std::sin(angle));
    const unsigned next = (i + 1) % kFacets;
    tube->triangles.push_back({2 * i, 2 * next, 2 * i + 1});
    tube->triangles.push_back({2 * i + 1, 2 * next, 2 * next + 1});
  }
  const Shape shape(std::shared_ptr<const Mesh>(std::move(tube)));
  const ShapeSamples samples = samplesOf(*cpuTreeOf(shape, tessellate(shape)));
  EXPECT_LT(samples.pieces.size(), 300000u);
}

TEST_F(BallCoverTest, OfAMeshWithoutExtentIsABall)
{
  auto point = std::make_shared<Mesh>();
  point->vertices.assign(3, Vector3d(1.0, 2.0, 3.0));
  point->triangles.push_back({0, 1, 2});
  auto ulp = std::make_shared<Mesh>();
  ulp->vertices = {Vector3d(1.0, 0.0, 0.0), Vector3d(1.0 + 2.3e-16, 0.0, 0.0), Vector3d(1.0, 0.0, 0.0)};
  ulp->triangles.push_back({0, 1, 2});
  for (const auto& mesh : {point, ulp})
  {
    const Shape shape(std::shared_ptr<const Mesh>{mesh});
    const auto tree = cpuTreeOf(shape, tessellate(shape));
    const BallCover cover = coverOf(*tree, samplesOf(*tree), 0.0);
    for (const auto& level : cover.levels)
      for (const Vector3d& vertex : mesh->vertices)
        EXPECT_TRUE(isIn(vertex, level));
    EXPECT_LT(cover.levels[0].front().outer, 1e-6);
  }
}

TEST_F(BallCoverTest, EachComponentContainsABallOfTheThickness)
{
  forEachShape(
      [](const CpuTree& tree, const BallCover& cover, double)
      {
        if (cover.thickness == 0.0)
          return;
        ASSERT_LE(componentsOf(tree).size(), 1u);
        bool found = false;
        for (const auto& level : cover.levels)
          for (const CoverBall& ball : level)
            found = found || ball.inner >= cover.thickness;
        ASSERT_TRUE(found);
      });
}
}  // namespace
}  // namespace gpu_planning_scene::core
