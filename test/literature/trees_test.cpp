// The bounding volumes of the trees enclose what they should enclose.

#include <gtest/gtest.h>

#include "literature/models.h"
#include "literature/poses.h"
#include "literature/trees/box_tree.h"
#include "literature/trees/dop18.h"
#include "literature/trees/dop24.h"
#include "literature/trees/oriented_boxes.h"

namespace gpu_planning_scene::core::literature
{
namespace
{
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kRounding = 1e-12;    // metres, for shapes of a metre
constexpr double kLargestEdge = 0.25;  // metres, of the lump

const Mesh& lumpMesh()
{
  static const std::shared_ptr<const Mesh> mesh = lump(300);
  return *mesh;
}

template <std::size_t kAxes>
Slabs<kAxes> slabsOf(const DopAxes<kAxes>& axes, const Triangle& t)
{
  Slabs<kAxes> slabs;
  for (std::size_t i = 0; i < kAxes; ++i)
  {
    slabs.lower[i] = std::min({axes[i].dot(t[0]), axes[i].dot(t[1]), axes[i].dot(t[2])});
    slabs.upper[i] = std::max({axes[i].dot(t[0]), axes[i].dot(t[1]), axes[i].dot(t[2])});
  }
  return slabs;
}
}  // namespace

TEST(OrientedBoxTree, EachBoxEnclosesItsTriangles)
{
  const OrientedBoxTree tree(lumpMesh());
  std::size_t leaves = 0;
  const std::function<std::vector<Vector3d>(std::uint32_t, const Isometry3d&)> check =
      [&](std::uint32_t number, const Isometry3d& parent)
  {
    const OrientedBoxTree::Node& node = tree.nodes()[number];
    Isometry3d frame = Isometry3d::Identity();
    frame.linear() = node.rotation;
    frame.translation() = node.center;
    frame = parent * frame;
    std::vector<Vector3d> corners;
    if (node.child == 0)
    {
      ++leaves;
      corners.assign(tree.triangles()[node.triangle].begin(), tree.triangles()[node.triangle].end());
    }
    else
      for (std::uint32_t child = node.child; child < node.child + 2; ++child)
        for (const Vector3d& corner : check(child, frame))
          corners.push_back(corner);
    for (const Vector3d& corner : corners)
      EXPECT_TRUE(((frame.inverse() * corner).cwiseAbs().array() <= node.half.array() + kRounding).all());
    return corners;
  };
  check(0, Isometry3d::Identity());
  EXPECT_EQ(leaves, lumpMesh().triangles.size());
}

// Two boxes whose axes differ by rounding errors have no common perpendicular, only noise.
TEST(OrientedBoxesOfTrees, EpsilonKeepsParallelBoxesTogether)
{
  Matrix3d rotation = Matrix3d::Identity();
  rotation(1, 0) = 1e-17;
  const Vector3d half(1.0, 0.1, 0.1);
  const Vector3d overlapping(1.5, 0.0, 0.15);
  EXPECT_TRUE(boxesApart(rotation, overlapping, half, half, 0.0));
  EXPECT_FALSE(boxesApart(rotation, overlapping, half, half, kRapidEpsilon));
  EXPECT_TRUE(boxesApart(rotation, Vector3d(1.5, 0.0, 0.21), half, half, kRapidEpsilon));
}

TEST(OrientedBoxesOfTrees, AnyOfFifteenAxesSeparates)
{
  // The edges of two rods cross each other. Only the product of their directions separates them.
  Matrix3d rotation;
  rotation = Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitZ()) * Eigen::AngleAxisd(0.25 * M_PI, Vector3d::UnitX());
  const Vector3d rod(1.0, 0.1, 0.1);
  const Matrix3d turned = Eigen::AngleAxisd(0.25 * M_PI, Vector3d::UnitX()).toRotationMatrix().transpose() * rotation;
  const Vector3d across = Eigen::AngleAxisd(-0.25 * M_PI, Vector3d::UnitX()) * Vector3d::UnitZ();
  EXPECT_TRUE(boxesApart(turned, 0.29 * across, rod, rod, kRapidEpsilon));
  EXPECT_FALSE(boxesApart(turned, 0.27 * across, rod, rod, kRapidEpsilon));
}

TEST(DopTree, EachDopEnclosesItsTriangles)
{
  const DopTree<9> tree(lumpMesh(), axesOf18Dop());
  const std::function<void(std::uint32_t, const Slabs<9>&)> check = [&](std::uint32_t number, const Slabs<9>& parent)
  {
    const auto& node = tree.nodes()[number];
    const Slabs<9> own = node.child == 0 ? slabsOf(axesOf18Dop(), tree.triangles()[node.triangle]) : node.slabs;
    for (std::size_t i = 0; i < 9; ++i)
    {
      EXPECT_GE(own.lower[i], parent.lower[i]);
      EXPECT_LE(own.upper[i], parent.upper[i]);
    }
    if (node.child != 0)
    {
      check(node.child, node.slabs);
      check(node.child + 1, node.slabs);
    }
  };
  check(0, tree.nodes().front().slabs);
}

TEST(Dop18, CornersSpanTheDop)
{
  const DopTree<9> tree(lumpMesh(), axesOf18Dop());
  for (const auto& node : tree.nodes())
  {
    const std::vector<Vector3d> corners = cornersOf(node.slabs);
    for (std::size_t i = 0; i < 9; ++i)
    {
      double lower = 1e9;
      double upper = -1e9;
      for (const Vector3d& corner : corners)
      {
        lower = std::min(lower, axesOf18Dop()[i].dot(corner));
        upper = std::max(upper, axesOf18Dop()[i].dot(corner));
      }
      EXPECT_NEAR(lower, node.slabs.lower[i], 1e-8);
      EXPECT_NEAR(upper, node.slabs.upper[i], 1e-8);
    }
  }
}

TEST(Dop24, RealignedDopsEncloseTheTurnedTriangles)
{
  const std::vector<Triangle> triangles = trianglesOf(lumpMesh());
  for (const Isometry3d& pose : posesAt(1.0, 50, 1))
  {
    const Realignment realigned(pose);
    for (const Triangle& t : triangles)
    {
      const Slabs<12> aligned = realigned(slabsOf(axesOf24Dop(), t));
      const Slabs<12> tight = slabsOf(axesOf24Dop(), moved(t, pose.linear(), pose.translation()));
      for (std::size_t i = 0; i < 12; ++i)
      {
        EXPECT_LE(aligned.lower[i], tight.lower[i] + kRounding);
        EXPECT_GE(aligned.upper[i], tight.upper[i] - kRounding);
        // A turned DOP may grow, but not without end.
        EXPECT_LE(aligned.upper[i] - aligned.lower[i], 2.0 * (tight.upper[i] - tight.lower[i]) + kLargestEdge);
      }
    }
  }
}

TEST(Dop24, WithoutARotationNothingChanges)
{
  const Slabs<12> slabs = slabsOf(axesOf24Dop(), trianglesOf(lumpMesh()).front());
  const Slabs<12> aligned = Realignment(Isometry3d::Identity())(slabs);
  for (std::size_t i = 0; i < 12; ++i)
  {
    EXPECT_NEAR(aligned.lower[i], slabs.lower[i], kRounding);
    EXPECT_NEAR(aligned.upper[i], slabs.upper[i], kRounding);
  }
}

TEST(BoxTree, EachBoxEnclosesItsTriangles)
{
  const BoxTree tree(lumpMesh());
  std::size_t leaves = 0;
  const std::function<void(std::uint32_t, FloatBox)> check = [&](std::uint32_t number, FloatBox box)
  {
    const BoxTree::Node& node = tree.nodes()[number];
    if (number != 0)
      (node.side % 2 == 0 ? box.lower : box.upper)[node.side / 2] = node.plane;
    for (std::uint32_t i = 0; i < node.children; ++i)
      check(node.child + i, box);
    if (node.children != 0)
      return;
    ++leaves;
    for (const Vector3d& corner : tree.triangles()[node.child])
      for (int axis = 0; axis < 3; ++axis)
      {
        EXPECT_GE(corner[axis], box.lower[axis]);
        EXPECT_LE(corner[axis], box.upper[axis]);
      }
  };
  check(0, tree.rootBox());
  EXPECT_EQ(leaves, lumpMesh().triangles.size());
}
}  // namespace gpu_planning_scene::core::literature
