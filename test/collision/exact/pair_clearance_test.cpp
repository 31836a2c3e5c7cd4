// The clearance of two shapes, beside the same exact tests of all pairs of triangles without a tree.

#include "collision/exact/pair_clearance.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "collision/exact/random_geometry.h"
#include "collision/geometry/cpu_box_pair.h"
#include "collision/geometry/primitive_solid.h"
#include "support/repetitions.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kAccuracy = 1.0001e-6;  // metres: pairClearance() promises 1e-6

class PairClearance : public testing::Test
{
 protected:
  Vector3d vector(double largest)
  {
    return {random_.uniform(-largest, largest), random_.uniform(-largest, largest), random_.uniform(-largest, largest)};
  }

  Isometry3d poseAt(const Vector3d& position)
  {
    return Eigen::Translation3d(position) * Eigen::AngleAxisd(random_.uniform(-3.0, 3.0), random_.direction());
  }

  /// Triangles around `center`. Some are degenerate, and some meshes have one triangle far from the others.
  std::shared_ptr<const Mesh> mesh(const Vector3d& center)
  {
    auto made = std::make_shared<Mesh>();
    const auto add = [&](const Vector3d& near, double size)
    {
      const auto first = static_cast<std::uint32_t>(made->vertices.size());
      for (int corner = 0; corner < 3; ++corner)
        made->vertices.push_back(near + vector(size));
      if (random_.number() % 5 == 0)
        made->vertices.back() = made->vertices[first];
      made->triangles.push_back({first, first + 1, first + 2});
    };
    const double size = random_.size(1e-3, 0.3);
    const std::uint64_t count = 1 + random_.number() % (random_.number() % 3 == 0 ? 4 : 60);
    for (std::uint64_t i = 0; i < count; ++i)
      add(center + vector(0.3), size);
    if (random_.number() % 5 == 0)
      add(center + Vector3d(100.0, 0.0, 0.0), size);
    return made;
  }

  Shape solid()
  {
    const double width = random_.uniform(0.05, 0.3);
    const double length = random_.uniform(0.05, 0.5);
    switch (random_.number() % 4)
    {
      case 0:
        return Box{{width, length, 0.2}};
      case 1:
        return Sphere{width};
      case 2:
        return Cylinder{width, length};
      default:
        return Cone{width, length};
    }
  }

  RandomGeometry random_{kSeed};
};

/// Two placed shapes; the first is a mesh.
struct Placed
{
  std::shared_ptr<const CpuTree> a;
  std::shared_ptr<const CpuTree> b;
  Isometry3d b_in_a;

  /// Whether the surfaces are within a distance, by tests of all pairs of triangles.
  bool within(double distance) const
  {
    const Isometry3d a_in_b = b_in_a.inverse();
    for (const Triangle& t : a->triangles)
    {
      if (!b->mesh && triangleWithinSolid({a_in_b * t[0], a_in_b * t[1], a_in_b * t[2]}, b->shape, distance))
        return true;
      for (std::size_t k = 0; b->mesh && k < b->triangles.size(); ++k)
      {
        const Triangle& u = b->triangles[k];
        if (trianglesWithin(t, {b_in_a * u[0], b_in_a * u[1], b_in_a * u[2]}, distance))
          return true;
      }
    }
    return false;
  }
};

TEST_F(PairClearance, IsThatOfTheNearestTrianglesToAMicrometreAndNeverMore)
{
  CpuShapePair::Scratch scratch;
  int apart = 0;
  for (int i = 0; i < repetitions(300, 10000); ++i)
  {
    const Vector3d center_a = vector(i % 5 == 0 ? 300.0 : 0.0);  // in the frame of the shape
    const Vector3d center_b = vector(i % 7 == 0 ? 300.0 : 0.0);
    const bool is_solid = i % 3 == 0;
    const Shape shape_a = mesh(center_a);
    const Shape shape_b = is_solid ? solid() : Shape(mesh(center_b));
    Isometry3d pose_a = poseAt(Vector3d::Zero());
    Isometry3d pose_b = poseAt(Vector3d::Zero());
    const Vector3d place = vector(i % 11 == 0 ? 500.0 : 0.0);
    pose_a.translation() = place - pose_a.linear() * center_a;
    pose_b.translation() = place + random_.uniform(0.3, 3.0) * random_.direction() -
                           (is_solid ? Vector3d(Vector3d::Zero()) : Vector3d(pose_b.linear() * center_b));
    const Placed placed{cpuTreeOf(shape_a, tessellate(shape_a)), cpuTreeOf(shape_b, tessellate(shape_b)),
                        relativePose(pose_a, pose_b)};
    const double required = i % 2 == 0 ? 0.0 : random_.uniform(0.0, 0.05);
    if (placed.within(required))
      continue;
    ++apart;
    const double most = i % 6 == 0 ? random_.uniform(0.0, 2.0) : i % 13 == 0 ? 1e300 : 1000.0;
    const double found = pairClearance(*placed.a, pose_a, *placed.b, pose_b, required, most, scratch).clearance;
    if (!placed.within(required + most))
    {
      EXPECT_EQ(found, most) << "seed " << kSeed << ", pair " << i;
      continue;
    }
    EXPECT_TRUE(found == 0.0 || !placed.within(required + found))
        << "seed " << kSeed << ", pair " << i << ": " << found;
    EXPECT_TRUE(placed.within(required + found + kAccuracy)) << "seed " << kSeed << ", pair " << i << ": " << found;
  }
  EXPECT_GT(apart, 100);
}

TEST_F(PairClearance, OfTwoSolidsIsTheirDistanceToAMicrometreAndNeverMore)
{
  CpuShapePair::Scratch scratch;
  int apart = 0;
  for (int i = 0; i < repetitions(300, 10000); ++i)
  {
    const Shape a = solid();
    const Shape b = solid();
    const Isometry3d pose = poseAt(random_.uniform(0.1, 2.0) * random_.direction());
    if (solidsWithin(a, b, pose, 0.0))
      continue;
    ++apart;
    const double found =
        pairClearance(*makeSolidTree(a), Isometry3d::Identity(), *makeSolidTree(b), pose, 0.0, 100.0, scratch)
            .clearance;
    EXPECT_TRUE(found == 0.0 || !solidsWithin(a, b, pose, found)) << "seed " << kSeed << ", pair " << i;
    EXPECT_TRUE(solidsWithin(a, b, pose, found + kAccuracy)) << "seed " << kSeed << ", pair " << i;
    EXPECT_NEAR(distanceOfSolids(a, b, pose), found, 2e-6) << "seed " << kSeed << ", pair " << i;
  }
  EXPECT_GT(apart, 100);
}

TEST_F(PairClearance, BisectionIsRightWithAnyEstimateAndShortWithAGoodOne)
{
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1000; ++i)
  {
    const double least = random_.uniform(1e-5, 2.0);
    for (const double estimate : {std::nan(""), kUnbounded, -kUnbounded, 0.0, 2.0, random_.uniform(-1.0, 3.0), least,
                                  least + 5e-7, least - 5e-7})
    {
      int calls = 0;
      const auto holds = [&](double x)
      {
        ++calls;
        return x >= least;
      };
      const double found = bisectLeast(0.0, 2.0, holds, estimate);
      EXPECT_LE(found, least) << "seed " << kSeed << ", estimate " << estimate;
      EXPECT_GE(found, least - kAccuracy) << "seed " << kSeed << ", estimate " << estimate;
      if (estimate == least)
        EXPECT_EQ(calls, 2);
    }
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
