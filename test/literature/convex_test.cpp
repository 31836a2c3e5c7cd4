// The method with convex patches agrees with the oracle for closed meshes, and fails for open meshes and containment.

#include <gtest/gtest.h>

#include "literature/convex/convex_hull.h"
#include "literature/convex/surface_patches.h"
#include "literature/method.h"
#include "literature/solids.h"
#include "oracle/oracle.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;
using MeshPtr = std::shared_ptr<const Mesh>;

bool collides(const MeshPtr& a, const MeshPtr& b, const Isometry3d& b_in_a)
{
  return convexMethods().at(0).make(a, b)->collide({b_in_a})[0] != 0;
}

bool oracleCollides(const MeshPtr& a, const MeshPtr& b, const Isometry3d& b_in_a)
{
  return oracle::verdict(oracle::PreparedShape(Shape(a)), oracle::Motion(), oracle::PreparedShape(Shape(b)),
                         oracle::Motion(b_in_a), 0.0) == oracle::Verdict::Collides;
}

Isometry3d placed(double x, double y, double z, double angle = 0.0)
{
  Isometry3d pose(Eigen::AngleAxisd(angle, Vector3d(1.0, 2.0, 3.0).normalized()));
  pose.pretranslate(Vector3d(x, y, z));
  return pose;
}

/// The outline of an L in the square from 0 to 1, whose notch begins at 0.4, with a height of 1.
MeshPtr ell()
{
  auto mesh = std::make_shared<Mesh>();
  const std::vector<Eigen::Vector2d> outline{{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.4}, {0.4, 0.4}, {0.4, 1.0}, {0.0, 1.0}};
  for (const double z : {0.0, 1.0})
    for (const Eigen::Vector2d& corner : outline)
      mesh->vertices.emplace_back(corner.x(), corner.y(), z);
  for (const auto& t : std::vector<std::array<std::uint32_t, 3>>{{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}})
  {
    mesh->triangles.push_back({t[0], t[2], t[1]});
    mesh->triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
  }
  for (std::uint32_t i = 0; i < 6; ++i)
  {
    const std::uint32_t next = (i + 1) % 6;
    mesh->triangles.push_back({i, next, next + 6});
    mesh->triangles.push_back({i, next + 6, i + 6});
  }
  return mesh;
}

TEST(ConvexHull, OfRandomPointsHasAllPointsInsideAndIsClosed)
{
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const int count : {4, 20, 500})
  {
    std::vector<Vector3d> points;
    for (int i = 0; i < count; ++i)
    {
      const double x = uniform(generator);
      const double y = uniform(generator);
      points.emplace_back(x, y, uniform(generator));
    }
    const ConvexHull hull = convexHull(points, 1e-12);
    ASSERT_GE(hull.facets.size(), 4u);
    EXPECT_EQ(hull.facets.size(), 2 * hull.vertices.size() - 4) << "Euler's formula";
    for (const HullFacet& facet : hull.facets)
      for (const Vector3d& point : points)
        EXPECT_LE(facet.normal.dot(point), facet.offset + 1e-11);
  }
}

TEST(ConvexHull, OfPointsInAPlaneHasNoFacetsButAnArea)
{
  const std::vector<Vector3d> square{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5, 0.5, 1}};
  const ConvexHull hull = convexHull(square, 1e-12);
  EXPECT_TRUE(hull.facets.empty());
  EXPECT_EQ(hull.vertices.size(), 4u);
  EXPECT_NEAR(hull.area, 1.0, 1e-12);
}

TEST(ConvexPatches, AConvexMeshIsOnePatch)
{
  EXPECT_EQ(convexPatches(*sphereMesh(0.5)).size(), 1u);
  EXPECT_EQ(convexPatches(*boxMesh({1.0, 2.0, 3.0})).size(), 1u);
}

TEST(ConvexPatches, EachTriangleIsInOnePatch)
{
  for (const MeshPtr& mesh : {torusMesh(0.4, 0.1), ell()})
  {
    std::vector<std::uint32_t> triangles;
    const std::vector<SurfacePatch> patches = convexPatches(*mesh);
    EXPECT_GT(patches.size(), 1u);
    EXPECT_LT(patches.size(), mesh->triangles.size());
    for (const SurfacePatch& patch : patches)
      triangles.insert(triangles.end(), patch.begin(), patch.end());
    std::sort(triangles.begin(), triangles.end());
    ASSERT_EQ(triangles.size(), mesh->triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
      EXPECT_EQ(triangles[i], i);
  }
}

TEST(ConvexSurfaces, AgreeWithTheOracleAtATenthOfPenetrationAndOfClearance)
{
  const MeshPtr ball = sphereMesh(0.3);
  const MeshPtr torus = torusMesh(0.4, 0.1);
  const MeshPtr box = boxMesh({1.0, 0.6, 0.5});
  for (const MeshPtr& a : {ball, torus, box, ell()})
    for (const MeshPtr& b : {ball, torus, box})
    {
      const auto method = convexMethods().at(0).make(a, b);
      int hits = 0;
      for (int i = 0; i < 12; ++i)
      {
        const Isometry3d pose = placed(0.16 * i, 0.05 * i, 0.02 * i, 0.7 * i);
        const bool expected = oracleCollides(a, b, pose);
        hits += expected ? 1 : 0;
        // Containment without a common point of the surfaces occurs only in shapes of one patch.
        EXPECT_EQ(method->collide({pose})[0] != 0, expected) << i;
      }
      EXPECT_GT(hits, 0);
      EXPECT_LT(hits, 12);
    }
}

TEST(ConvexSurfaces, LeaveABallInANotchFree)
{
  const MeshPtr ball = sphereMesh(0.15);
  for (const double z : {0.0, 0.5, 1.0})
  {
    EXPECT_FALSE(collides(ell(), ball, placed(0.6, 0.6, z))) << z;
    EXPECT_TRUE(collides(ell(), ball, placed(0.5, 0.5, z))) << z;
  }
  const MeshPtr torus = torusMesh(0.4, 0.1);
  EXPECT_FALSE(collides(torus, sphereMesh(0.25), Isometry3d::Identity())) << "in the hole";
  EXPECT_FALSE(collides(torus, torus, placed(0.4, 0.0, 0.0) * Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitX())));
}

TEST(ConvexSurfaces, FindContainmentInAConvexShapeAndMissItInADentedBall)
{
  const MeshPtr ball = sphereMesh(0.02);
  EXPECT_TRUE(collides(boxMesh({1.0, 1.0, 1.0}), ball, placed(0.2, 0.1, -0.3)));
  auto dented = std::make_shared<Mesh>(*sphereMesh(0.5));
  for (std::size_t i = 0; i < dented->vertices.size(); i += 3)
    dented->vertices[i] *= 0.9;
  ASSERT_TRUE(oracleCollides(dented, ball, Isometry3d::Identity()));
  EXPECT_FALSE(collides(dented, ball, Isometry3d::Identity()));
}

TEST(ConvexSurfaces, ReportABallInAnOpenBoxThatItDoesNotTouch)
{
  auto open = std::make_shared<Mesh>(*boxMesh({1.0, 1.0, 1.0}));
  open->triangles.erase(std::remove_if(open->triangles.begin(), open->triangles.end(),
                                       [&](const auto& t) {
                                         return std::all_of(t.begin(), t.end(),
                                                            [&](std::uint32_t vertex)
                                                            { return open->vertices[vertex].z() > 0.0; });
                                       }),
                        open->triangles.end());
  ASSERT_EQ(open->triangles.size(), 10u);
  const MeshPtr ball = sphereMesh(0.2);
  ASSERT_FALSE(oracleCollides(open, ball, Isometry3d::Identity()));
  EXPECT_TRUE(collides(open, ball, Isometry3d::Identity()));
}
}  // namespace
}  // namespace gpu_planning_scene::core::literature
