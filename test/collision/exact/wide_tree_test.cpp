// Wide trees hold each triangle, and their overlap test never separates boxes that touch, with each instruction set.

#include "collision/exact/wide_tree.h"

#include <random>

#include <gtest/gtest.h>

#include "collision/exact/cpu_tree.h"
#include "collision/geometry/cpu_box_pair.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

constexpr std::uint64_t kSeed = 47;

/// Counts in which leaf each triangle is. Expects that it is in the box of the leaf and of all boxes above.
void countTriangles(const CpuTree& tree, WideBox box, std::vector<OrientedBox> above, std::vector<int>& counts)
{
  const WideTree& wide = tree.wide;
  const WideNode& node = wide.node(box);
  const unsigned slot = WideTree::slot(box);
  OrientedBox grown{Matrix3d(), wide.center(box), Vector3d()};
  for (int k = 0; k < 3; ++k)
  {
    for (int axis = 0; axis < 3; ++axis)
      grown.axes(k, axis) = node.axes[axis][k][slot];
    grown.half[k] = node.half[k][slot] + 1e-6 * wide.reach();
  }
  above.push_back(grown);
  if (!wide.isLeaf(box))
  {
    for (unsigned i = 0; i < wide.below(box).boxes; ++i)
      countTriangles(tree, wide.child(box, i), above, counts);
    return;
  }
  for (std::uint32_t i = wide.firstTriangle(box); i < wide.firstTriangle(box) + wide.triangleCount(box); ++i)
  {
    ++counts.at(i);
    for (const OrientedBox& around : above)
      for (const Vector3d& corner : tree.triangles[i])
      {
        ASSERT_TRUE(around.contains(corner));
        ASSERT_LE((corner - wide.center(box)).norm(), wide.radius(box) + wide.centerError());
      }
  }
}

TEST(WideTrees, HoldEachTriangleOnce)
{
  auto far_away = std::make_shared<Mesh>(*tessellate(Cone{0.1, 0.3}).mesh);
  for (Vector3d& vertex : far_away->vertices)
    vertex += Vector3d(500.0, -2000.0, 3.0);
  auto single = std::make_shared<Mesh>();
  single->vertices = {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()};
  single->triangles.push_back({0, 1, 2});
  for (const std::shared_ptr<const Mesh>& mesh :
       {tessellate(Sphere{0.2}).mesh, tessellate(Box{{1.0, 0.2, 0.01}}).mesh, std::shared_ptr<const Mesh>(far_away),
        std::shared_ptr<const Mesh>(single)})
  {
    const Shape shape(mesh);
    const auto tree = cpuTreeOf(shape, tessellate(shape));
    std::vector<int> counts(tree->triangles.size());
    countTriangles(*tree, WideTree::kRoot, {}, counts);
    EXPECT_EQ(counts, std::vector<int>(counts.size(), 1));
  }
}

class WideOverlap : public testing::TestWithParam<NamedOverlapTest>
{
 protected:
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(generator_); }
  double size(double least, double most) { return std::exp(uniform(std::log(least), std::log(most))); }

  Vector3d direction()
  {
    std::normal_distribution<double> normal;
    return Vector3d(normal(generator_), normal(generator_), normal(generator_)).normalized();
  }

  /// A random rotation, none, or one by a tiny angle.
  Matrix3d rotation()
  {
    switch (generator_() % 3)
    {
      case 0:
        return AngleAxisd(uniform(0.0, 3.0), direction()).toRotationMatrix();
      case 1:
        return Matrix3d::Identity();
      default:
        return AngleAxisd(size(1e-9, 1e-3), direction()).toRotationMatrix();
    }
  }

  OrientedBox box()
  {
    const double length = size(1e-3, 10.0);
    const auto side = [&] { return generator_() % 4 == 0 ? 0.0 : length * size(1e-3, 1.0); };
    return {rotation(), generator_() % 2 == 0 ? Vector3d::Zero() : Vector3d(length * direction()),
            Vector3d(side(), side(), length)};
  }

  /// Two boxes of random poses. Every second pair is parallel up to rounding, which is the hard case of the test.
  struct Pair
  {
    OrientedBox a;
    OrientedBox b;
    Isometry3d b_in_a = Isometry3d::Identity();
  };
  Pair pair()
  {
    Pair pair;
    pair.a = box();
    pair.b = box();
    pair.b_in_a.linear() = rotation();
    if (generator_() % 2 == 0)
      pair.b.axes = pair.b_in_a.linear().transpose() * pair.a.axes;
    return pair;
  }

  /// A direction in which a face or an edge of one of the boxes lies, or any.
  Vector3d contactNormal(const OrientedBox& a, const Matrix3d& axes_of_b)
  {
    Vector3d normal = direction();
    const auto axis = [&](const Matrix3d& axes) { return Vector3d(axes.col(static_cast<int>(generator_() % 3))); };
    switch (generator_() % 4)
    {
      case 0:
        normal = axis(a.axes);
        break;
      case 1:
        normal = axis(axes_of_b);
        break;
      case 2:
        normal = axis(a.axes).cross(axis(axes_of_b));
        break;
      default:
        break;
    }
    return normal.norm() < 1e-12 ? direction() : Vector3d(normal.normalized());
  }

  /// The corner of the box that is farthest in a direction.
  static Vector3d support(const OrientedBox& box, const Vector3d& normal)
  {
    const Vector3d along = box.axes.transpose() * normal;
    return box.center +
           box.axes * box.half.cwiseProduct(along.unaryExpr([](double x) { return x < 0.0 ? -1.0 : 1.0; }));
  }

  /// Whether the test under test keeps the pair.
  static bool overlap(const OrientedBox& a, const OrientedBox& b, const Isometry3d& b_in_a)
  {
    const WideTree tree_a({leaf(a)}, a.center);
    const WideTree tree_b({leaf(b)}, Vector3d::Zero());
    const FloatFrame frame(tree_b, b_in_a, tree_a, 0.0);
    return GetParam().test(tree_a.node(WideTree::kRoot), frame.place(tree_b, WideTree::kRoot)) != 0;
  }

  static double lengthsOf(const OrientedBox& a, const OrientedBox& b, const Isometry3d& b_in_a)
  {
    return (b_in_a.translation() - a.center).norm() + a.half.norm() + b.half.norm() + b.center.norm();
  }

  std::mt19937_64 generator_{kSeed};

 private:
  static CpuNode leaf(const OrientedBox& box)
  {
    CpuNode node;
    node.box = box;
    node.first = 0;
    node.count = 1;
    return node;
  }
};

TEST_P(WideOverlap, KeepsBoxesThatTouch)
{
  for (int i = 0; i < 100000; ++i)
  {
    auto [a, b, b_in_a] = pair();
    const Vector3d normal = contactNormal(a, b_in_a.linear() * b.axes);
    b_in_a.translation() = support(a, normal) - b_in_a.linear() * support(b, b_in_a.linear().transpose() * -normal);
    ASSERT_TRUE(overlap(a, b, b_in_a)) << "pair " << i << ", seed " << kSeed;
  }
}

TEST_P(WideOverlap, SeparatesBoxesThatAreApartByMoreThanTheRoundingErrors)
{
  std::size_t separated = 0;
  for (int i = 0; i < 100000; ++i)
  {
    auto [a, b, b_in_a] = pair();
    b_in_a.translation() = a.center + size(1e-3, 10.0) * direction();
    // Grown by 1e-4 of the lengths, ten times the largest margin of the test, the boxes must still be apart.
    if (core::overlap(a, placed(b, b_in_a), 1e-4 * lengthsOf(a, b, b_in_a)))
      continue;
    ++separated;
    ASSERT_FALSE(overlap(a, b, b_in_a)) << "pair " << i << ", seed " << kSeed;
  }
  EXPECT_GT(separated, 10000u);
}

INSTANTIATE_TEST_SUITE_P(Instructions, WideOverlap, testing::ValuesIn(availableOverlapTests()),
                         [](const auto& tested) { return std::string(tested.param.instructions); });
}  // namespace
}  // namespace gpu_planning_scene::core
