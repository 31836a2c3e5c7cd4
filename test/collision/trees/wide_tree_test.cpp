// Wide trees hold each triangle, and their overlap test never separates boxes that touch, with each instruction set.

#include "collision/trees/wide_tree.h"

#include <gtest/gtest.h>

#include "collision/exact/cpu_shape_pair.h"
#include "collision/exact/random_geometry.h"
#include "collision/geometry/cpu_box_pair.h"
#include "collision/trees/cpu_tree.h"
#include "collision/trees/wide_tests.h"
#include "support/seed.h"

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

/// Counts in which leaf each triangle is. Expects that it is in the box of the leaf and of all boxes above.
void countTriangles(const CpuTree& tree, BoxIndex box, std::vector<OrientedBox> above, std::vector<int>& counts)
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
  const CpuNode& leaf = tree.nodes[wide.source(box)];
  for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
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

/// A square plate of triangles with sides of 5 mm.
std::shared_ptr<Mesh> plate(unsigned cells)
{
  auto mesh = std::make_shared<Mesh>();
  for (unsigned i = 0; i <= cells; ++i)
    for (unsigned j = 0; j <= cells; ++j)
      mesh->vertices.emplace_back(0.005 * i, 0.005 * j, 0.0);
  for (unsigned i = 0; i < cells; ++i)
    for (unsigned j = 0; j < cells; ++j)
    {
      const unsigned corner = i * (cells + 1) + j;
      mesh->triangles.push_back({corner, corner + 1, corner + cells + 1});
      mesh->triangles.push_back({corner + 1, corner + cells + 1, corner + cells + 2});
    }
  return mesh;
}

/// The float errors grow with the reach of a mesh. Without tests in double, all triangles near the other plate would be
/// tested.
TEST(WideTrees, OfAMeshWithAStrayTriangleFarAwayCostLittle)
{
  const auto mesh = plate(100);
  const auto first = static_cast<unsigned>(mesh->vertices.size());
  for (const Vector3d& corner : {Vector3d(100.0, 0.0, 0.0), Vector3d(100.0, 1.0, 0.0), Vector3d(100.0, 0.0, 1.0)})
    mesh->vertices.push_back(corner);
  mesh->triangles.push_back({first, first + 1, first + 2});
  CollisionProblem problem;
  problem.shapes = {Shape(std::shared_ptr<const Mesh>(mesh)), Shape(std::shared_ptr<const Mesh>(plate(40)))};
  for (const Shape& shape : problem.shapes)
    problem.tessellations.push_back(tessellate(shape));
  const CpuShapePair pair(std::make_shared<const CpuForest>(problem));
  CpuShapePair::Scratch scratch;
  const Isometry3d above(Translation3d(0.1, 0.1, 0.0003));
  EXPECT_FALSE(pair.collide(0, Isometry3d::Identity(), 1, above, 0.0, scratch));
  EXPECT_LT(scratch.steps, 200u);
}

class WideOverlap : public testing::TestWithParam<WideTests>, protected RandomGeometry
{
 protected:
  WideOverlap() : RandomGeometry(kSeed) {}

  /// A random rotation, none, or one by a tiny angle.
  Matrix3d rotation()
  {
    switch (number() % 3)
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
    const auto side = [&] { return number() % 4 == 0 ? 0.0 : length * size(1e-3, 1.0); };
    return {rotation(), number() % 2 == 0 ? Vector3d::Zero() : Vector3d(length * direction()),
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
    if (number() % 2 == 0)
      pair.b.axes = pair.b_in_a.linear().transpose() * pair.a.axes;
    return pair;
  }

  /// A direction in which a face or an edge of one of the boxes lies, or any.
  Vector3d contactNormal(const OrientedBox& a, const Matrix3d& axes_of_b)
  {
    Vector3d normal = direction();
    const auto axis = [&](const Matrix3d& axes) { return Vector3d(axes.col(static_cast<int>(number() % 3))); };
    switch (number() % 4)
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

  /// Whether the test keeps the pair if b is grown by `growth`, as a box of another tree and as the box of a primitive.
  static bool keeps(const Pair& pair, double growth)
  {
    const std::vector<Triangle> triangles = {{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()}};
    const WideTree tree_a({leaf(pair.a)}, triangles, pair.a.center);
    const WideTree tree_b({leaf(pair.b)}, triangles, Vector3d::Zero());
    const WideNode& node = tree_a.node(WideTree::kRoot);
    const WidePlacement placement(tree_b, pair.b_in_a, tree_a, growth);
    return GetParam().overlap(node, placement.place(tree_b, WideTree::kRoot)) != 0 &&
           GetParam().overlap(node, floatBox(placed(pair.b, pair.b_in_a), tree_a, growth)) != 0;
  }

  static double lengthsOf(const Pair& pair)
  {
    return (pair.b_in_a.translation() - pair.a.center).norm() + pair.a.half.norm() + pair.b.half.norm() +
           pair.b.center.norm();
  }

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

TEST_P(WideOverlap, KeepsBoxesAtTheRequiredDistance)
{
  for (int i = 0; i < 100000; ++i)
  {
    Pair pair = this->pair();
    const double required = i % 2 == 0 ? 0.0 : size(1e-3, 10.0);
    const Vector3d normal = contactNormal(pair.a, pair.b_in_a.linear() * pair.b.axes);
    pair.b_in_a.translation() = support(pair.a, normal) + required * normal -
                                pair.b_in_a.linear() * support(pair.b, pair.b_in_a.linear().transpose() * -normal);
    ASSERT_TRUE(keeps(pair, required)) << "pair " << i << ", seed " << kSeed;
  }
}

TEST_P(WideOverlap, SeparatesBoxesThatAreApartByMoreThanTheRoundingErrors)
{
  std::size_t separated = 0;
  for (int i = 0; i < 100000; ++i)
  {
    Pair pair = this->pair();
    pair.b_in_a.translation() = pair.a.center + size(1e-3, 10.0) * direction();
    // Grown by 1e-4 of the lengths, several times the errors that the test allows for, the boxes must still be apart.
    if (overlap(pair.a, placed(pair.b, pair.b_in_a), 1e-4 * lengthsOf(pair)))
      continue;
    ++separated;
    ASSERT_FALSE(keeps(pair, 0.0)) << "pair " << i << ", seed " << kSeed;
  }
  EXPECT_GT(separated, 10000u);
}

INSTANTIATE_TEST_SUITE_P(Instructions, WideOverlap, testing::ValuesIn(availableWideTests()),
                         [](const auto& tested) { return std::string(tested.param.instructions); });
}  // namespace
}  // namespace gpu_planning_scene::core
