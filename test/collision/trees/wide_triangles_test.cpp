// The test of two leaves' triangles never separates triangles that collide, with each instruction set.

#include "collision/trees/wide_triangles.h"

#include <gtest/gtest.h>

#include "collision/exact/random_geometry.h"
#include "collision/trees/cpu_tree.h"
#include "collision/trees/wide_tests.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

class WideTriangles : public testing::TestWithParam<WideTests>, protected RandomGeometry
{
 protected:
  WideTriangles() : RandomGeometry(kSeed) {}

  /// Triangles of one leaf. Half of them are slivers; some are segments or points.
  std::vector<Triangle> triangles()
  {
    const double length = size(1e-3, 10.0);
    const Vector3d center = number() % 2 == 0 ? Vector3d::Zero() : Vector3d(length * direction());
    std::vector<Triangle> made(1 + number() % kBlockTriangles);
    for (Triangle& triangle : made)
    {
      for (Vector3d& corner : triangle)
        corner = center + length * uniform(0.1, 1.0) * direction();
      if (number() % 2 == 0)
        triangle[2] = triangle[0] + uniform(-0.5, 1.5) * (triangle[1] - triangle[0]) + size(1e-9, 1e-2) * direction();
      if (number() % 8 == 0)
        triangle[1] = triangle[0];
    }
    return made;
  }

  static WideTree treeOf(const std::vector<Triangle>& triangles)
  {
    CpuNode leaf;
    Eigen::AlignedBox3d bounds;
    for (const Triangle& triangle : triangles)
      for (const Vector3d& corner : triangle)
        bounds.extend(corner);
    leaf.box = {Eigen::Matrix3d::Identity(), bounds.center(), bounds.sizes() / 2.0};
    leaf.first = 0;
    leaf.count = static_cast<std::uint32_t>(triangles.size());
    return WideTree({leaf}, triangles, bounds.center());
  }

  /// The corner that is farthest in a direction.
  static Vector3d support(const Triangle& triangle, const Vector3d& normal)
  {
    return *std::max_element(
        triangle.begin(), triangle.end(),
        [&](const Vector3d& a, const Vector3d& b) { return normal.dot(a) < normal.dot(b); });
  }

  static Vector3d edge(const Triangle& triangle, std::uint64_t i) { return triangle[(i + 1) % 3] - triangle[i % 3]; }

  /// A direction in which a face or an edge of one of the triangles lies, or any.
  Vector3d contactNormal(const Triangle& a, const Triangle& b)
  {
    Vector3d normal = Vector3d::Zero();
    switch (number() % 4)
    {
      case 0:
        normal = edge(a, 0).cross(edge(a, 1));
        break;
      case 1:
        normal = edge(b, 0).cross(edge(b, 1));
        break;
      case 2:
        normal = edge(a, number()).cross(edge(b, number()));
        break;
      default:
        break;
    }
    if (normal.norm() < 1e-12)
      return direction();
    return normal.normalized() * (number() % 2 == 0 ? 1.0 : -1.0);
  }

  /// Bit kBlockTriangles * j + i: the test keeps triangle i of `a` and triangle j of `b`.
  static unsigned kept(const std::vector<Triangle>& a, const std::vector<Triangle>& b, const Isometry3d& b_in_a,
                       double growth)
  {
    const WideTree tree_a = treeOf(a);
    const WideTree tree_b = treeOf(b);
    const WidePlacement placement(tree_b, b_in_a, tree_a, growth);
    return GetParam().near_triangles(tree_a.triangles(WideTree::kRoot),
                                     placement.place(tree_b.triangles(WideTree::kRoot)), placement.distance());
  }

  static Triangle moved(const Triangle& t, const Isometry3d& pose) { return {pose * t[0], pose * t[1], pose * t[2]}; }
};

TEST_P(WideTriangles, AreKeptAtTheRequiredDistance)
{
  for (int trial = 0; trial < 100000; ++trial)
  {
    const std::vector<Triangle> a = triangles();
    const std::vector<Triangle> b = triangles();
    const std::size_t i = number() % a.size();
    const std::size_t j = number() % b.size();
    const double required = trial % 2 == 0 ? 0.0 : size(1e-3, 10.0);
    Isometry3d b_in_a(AngleAxisd(trial % 3 == 0 ? 0.0 : uniform(0.0, 3.0), direction()));
    const Triangle turned = moved(b[j], b_in_a);
    const Vector3d normal = contactNormal(a[i], turned);
    // The two corners are at the required distance, and a slab of this width separates the triangles.
    b_in_a.translation() = support(a[i], normal) + required * normal - support(turned, -normal);
    ASSERT_TRUE(kept(a, b, b_in_a, required) & 1U << (kBlockTriangles * j + i))
        << "trial " << trial << ", seed " << kSeed;
  }
}

TEST_P(WideTriangles, AreKeptIfTheyCollide)
{
  std::size_t collisions = 0;
  for (int trial = 0; trial < 20000; ++trial)
  {
    const std::vector<Triangle> a = triangles();
    const std::vector<Triangle> b = triangles();
    const double required = trial % 2 == 0 ? 0.0 : size(1e-3, 0.1);
    Isometry3d b_in_a(AngleAxisd(uniform(0.0, 3.0), direction()));
    b_in_a.translation() = a[0][0] - b_in_a * b[0][0] + size(1e-6, 1.0) * direction();
    const unsigned bits = kept(a, b, b_in_a, required + 1e-9);
    unsigned colliding = 0;
    for (std::size_t j = 0; j < b.size(); ++j)
      for (std::size_t i = 0; i < a.size(); ++i)
        if (trianglesWithin(a[i], moved(b[j], b_in_a), required))
          colliding |= 1U << (kBlockTriangles * j + i);
    ASSERT_EQ(colliding & ~bits, 0U) << "trial " << trial << ", seed " << kSeed;
    collisions += colliding != 0;
  }
  EXPECT_GT(collisions, 2000u);
}

TEST_P(WideTriangles, AreMostlySeparatedIfTheyAreApart)
{
  std::size_t apart = 0;
  std::size_t separated = 0;
  for (int trial = 0; trial < 20000; ++trial)
  {
    const std::vector<Triangle> a = triangles();
    const std::vector<Triangle> b = triangles();
    Isometry3d b_in_a(AngleAxisd(uniform(0.0, 3.0), direction()));
    b_in_a.translation() = size(1e-3, 10.0) * direction();
    const unsigned bits = kept(a, b, b_in_a, 0.0);
    ASSERT_EQ(bits >> (kBlockTriangles * b.size()), 0U) << "a triangle that does not exist, trial " << trial;
    for (std::size_t j = 0; j < b.size(); ++j)
      for (std::size_t i = 0; i < a.size(); ++i)
        if (!trianglesWithin(a[i], moved(b[j], b_in_a), 1e-3))
        {
          ++apart;
          separated += (bits >> (kBlockTriangles * j + i) & 1U) == 0;
        }
  }
  EXPECT_GT(apart, 10000u);
  EXPECT_GT(separated, apart * 95 / 100);
}

INSTANTIATE_TEST_SUITE_P(Instructions, WideTriangles, testing::ValuesIn(availableWideTests()),
                         [](const auto& tested) { return std::string(tested.param.instructions); });
}  // namespace
}  // namespace gpu_planning_scene::core
