// A body inside the solid of a mesh's closed components collides, although no surfaces meet.

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "support/moving_shape.h"
#include "support/obstacles.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Vector3d;
using MeshPointer = std::shared_ptr<const Mesh>;

MeshPointer changed(const MeshPointer& mesh, const std::function<void(Mesh&)>& change)
{
  auto copy = std::make_shared<Mesh>(*mesh);
  change(*copy);
  return copy;
}

MeshPointer boxMesh(double size)
{
  return tessellate(Box{{size, size, size}}).mesh;
}

MeshPointer inverted(const MeshPointer& mesh)
{
  return changed(
      mesh,
      [](Mesh& copy)
      {
        for (auto& corners : copy.triangles)
          std::swap(corners[0], corners[1]);
      });
}

/// Without the last face of a box. A hole of that size is not filled.
MeshPointer opened(const MeshPointer& mesh)
{
  return changed(
      mesh, [](Mesh& copy) { copy.triangles.resize(copy.triangles.size() - 2); });
}

MeshPointer moved(const MeshPointer& mesh, const Vector3d& shift)
{
  return changed(
      mesh,
      [&shift](Mesh& copy)
      {
        for (Vector3d& vertex : copy.vertices)
          vertex += shift;
      });
}

MeshPointer together(const MeshPointer& a, const MeshPointer& b)
{
  return changed(
      a,
      [&b](Mesh& copy)
      {
        const auto first = static_cast<std::uint32_t>(copy.vertices.size());
        copy.vertices.insert(copy.vertices.end(), b->vertices.begin(), b->vertices.end());
        for (const auto& corners : b->triangles)
          copy.triangles.push_back({corners[0] + first, corners[1] + first, corners[2] + first});
      });
}

/// Checks the pair with each of the two shapes as the moving shape.
void expectCollision(bool expected, const Shape& small, const Shape& large, const Eigen::Isometry3d& small_in_large,
                     const std::string& what)
{
  EXPECT_EQ(expected, MovingShape(small, {{large}}).collides(small_in_large)) << what;
  EXPECT_EQ(expected, MovingShape(large, {{small}}).collides(small_in_large.inverse())) << what << ", moving";
}

/// Shapes of every kind that can be inside another shape, all within 0.1 m of their frames' origins.
std::vector<Shape> smallShapes()
{
  return {Box{{0.1, 0.1, 0.1}},        Sphere{0.05},         Cylinder{0.04, 0.1}, Cone{0.04, 0.1}, Shape(boxMesh(0.1)),
          Shape(opened(boxMesh(0.1))), Shape(sheetMesh(0.1))};
}

TEST(Containment, InsideAClosedMeshCollidesAndInsideAnOpenOneDoesNot)
{
  // Some of the places send rays along the axes through edges and vertices.
  for (const Vector3d& place : {Vector3d(0, 0, 0), Vector3d(0.2, 0.2, 0.2), Vector3d(-0.3, 0.1, 0.25)})
  {
    for (const Shape& small : smallShapes())
    {
      const std::string what = "kind " + std::to_string(small.index());
      const Eigen::Isometry3d pose = at(place.x(), place.y(), place.z());
      expectCollision(true, small, boxMesh(1.0), pose, what + " in a closed mesh");
      expectCollision(true, small, inverted(boxMesh(1.0)), pose, what + " in an inverted mesh");
      expectCollision(false, small, opened(boxMesh(1.0)), pose, what + " in an open mesh");
      expectCollision(false, small, boxMesh(1.0), at(0.7, place.y(), place.z()), what + " beside");
    }
  }
}

TEST(Containment, AMirroredMeshIsASolidToo)
{
  const auto mirrored = changed(boxMesh(1.0),
                                [](Mesh& copy)
                                {
                                  for (Vector3d& vertex : copy.vertices)
                                    vertex.x() = -vertex.x();
                                });
  expectCollision(true, Sphere{0.1}, mirrored, at(0.1, 0.2, 0.1), "sphere");
  expectCollision(true, boxMesh(0.1), mirrored, at(0.1, 0.2, 0.1), "mesh");
}

TEST(Containment, ACavityIsFreeAndWhatIsAroundItIsNot)
{
  const MeshPointer hollow = together(boxMesh(2.0), inverted(boxMesh(1.0)));
  for (const Shape& small : smallShapes())
  {
    const std::string what = "kind " + std::to_string(small.index());
    expectCollision(false, small, hollow, at(0.2, -0.1, 0.3), what + " in the cavity");
    expectCollision(true, small, hollow, at(0.75, -0.1, 0.3), what + " in the wall");
    expectCollision(false, small, hollow, at(1.3, -0.1, 0.3), what + " outside");
  }
}

TEST(Containment, AShellInAShellOfTheSameDirectionIsNoCavity)
{
  expectCollision(true, Sphere{0.1}, together(boxMesh(2.0), boxMesh(1.0)), at(0.1, 0, 0), "sphere");
  expectCollision(true, boxMesh(0.1), together(boxMesh(2.0), boxMesh(1.0)), at(0.1, 0, 0), "mesh");
}

TEST(Containment, OneComponentInsideIsEnough)
{
  const MeshPointer two = together(moved(boxMesh(0.1), Vector3d(3, 0, 0)), boxMesh(0.1));
  expectCollision(true, two, boxMesh(1.0), at(0.1, 0, 0), "closed components");
  expectCollision(false, two, boxMesh(1.0), at(-1.5, 0, 0), "one on either side");
  expectCollision(true, opened(two), boxMesh(1.0), at(0.1, 0, 0), "the one inside is open");
  expectCollision(true, two, Sphere{0.5}, at(0.1, 0, 0), "in a sphere");
  expectCollision(false, two, Sphere{0.5}, at(-1.5, 0, 0), "beside a sphere");
}

TEST(Containment, AnOpenComponentDoesNotSpoilTheSolidOfAClosedOne)
{
  const MeshPointer mixed = together(boxMesh(1.0), opened(moved(boxMesh(4.0), Vector3d(5, 0, 0))));
  expectCollision(true, Sphere{0.1}, mixed, at(0.1, 0.2, 0), "in the closed one");
  expectCollision(false, Sphere{0.1}, mixed, at(5.1, 0.2, 0), "in the open one");
  const MeshPointer hollow = together(together(boxMesh(2.0), inverted(boxMesh(1.0))), opened(boxMesh(0.6)));
  for (const Vector3d& place : {Vector3d(0.2, 0, 0), Vector3d(-0.2, 0, 0), Vector3d(0, 0.2, 0), Vector3d(0, -0.2, 0)})
    expectCollision(false, Sphere{0.05}, hollow, at(place.x(), place.y(), place.z()), "in an open one in a cavity");
}

TEST(Containment, PaddingDoesNotMakeOutsideInside)
{
  MovingShape pairs(boxMesh(0.1), {{together(boxMesh(2.0), inverted(boxMesh(1.0)))}}, {0.1, 0.05});
  EXPECT_FALSE(pairs.collides(at(0, 0, 0.25)));
  EXPECT_TRUE(pairs.collides(at(0, 0, 0.35)));
  EXPECT_TRUE(pairs.collides(at(0.75, 0, 0)));
}

TEST(Containment, AgreesWithRaysInRandomPoses)
{
  const std::uint64_t seed = 51;
  std::mt19937_64 generator(seed);
  const MeshPointer torus = torusMesh(0.3, 0.15);
  const MeshPointer dot = boxMesh(1e-4);
  MovingShape mesh(dot, {{torus}});
  MovingShape sphere(Sphere{1e-4}, {{torus}});
  int inside = 0;
  for (int i = 0; i < 300; ++i)
  {
    const Eigen::Isometry3d pose = randomPose(generator, 0.4);
    const double from_circle = std::hypot(pose.translation().head<2>().norm() - 0.3, pose.translation().z());
    if (std::abs(from_circle - 0.15) < 0.01)
      continue;  // near the surface
    inside += from_circle < 0.15 ? 1 : 0;
    EXPECT_EQ(from_circle < 0.15, mesh.collides(pose)) << "seed " << seed << ", pose " << i;
    EXPECT_EQ(from_circle < 0.15, sphere.collides(pose)) << "seed " << seed << ", pose " << i;
  }
  EXPECT_GT(inside, 30);
}
}  // namespace
}  // namespace gpu_planning_scene::core
