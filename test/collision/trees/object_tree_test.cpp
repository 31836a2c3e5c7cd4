#include "collision/trees/object_tree.h"

#include <algorithm>
#include <iostream>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace gpu_planning_scene::core
{
namespace
{
using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr std::uint64_t kTreeSeed = 50;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

AlignedBox3d randomBox(std::mt19937_64& random, double size)
{
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Vector3d low(uniform(random), uniform(random), uniform(random));
  return {low, low + size * Vector3d(uniform(random), uniform(random), uniform(random)).cwiseAbs()};
}

class ObjectTreeVisit : public testing::Test
{
 protected:
  ObjectTreeVisit()
  {
    std::cout << "seed " << kTreeSeed << std::endl;
    for (int i = 0; i < 300; ++i)
      boxes_.push_back(randomBox(random_, 0.2));
    tree_ = ObjectTree(boxes_, ObjectTree());
  }

  std::vector<std::uint32_t> visited(const AlignedBox3d& bounds)
  {
    std::vector<std::uint32_t> objects;
    EXPECT_FALSE(tree_.visitOverlapping(bounds, stack_,
                                        [&objects](std::uint32_t object)
                                        {
                                          objects.push_back(object);
                                          return false;
                                        }));
    std::sort(objects.begin(), objects.end());
    return objects;
  }

  /// The objects whose boxes overlap, found without the tree.
  std::vector<std::uint32_t> overlapping(const AlignedBox3d& bounds) const
  {
    std::vector<std::uint32_t> objects;
    for (std::uint32_t i = 0; i < boxes_.size(); ++i)
      if (boxes_[i].intersects(bounds))
        objects.push_back(i);
    return objects;
  }

  std::mt19937_64 random_{kTreeSeed};
  std::vector<AlignedBox3d> boxes_;
  ObjectTree tree_;
  std::vector<std::uint32_t> stack_;
};

TEST_F(ObjectTreeVisit, VisitsTheObjectsWhoseBoxesOverlap)
{
  std::size_t found = 0;
  for (int i = 0; i < 300; ++i)
  {
    const AlignedBox3d bounds = randomBox(random_, 0.5);
    const std::vector<std::uint32_t> expected = overlapping(bounds);
    ASSERT_EQ(expected, visited(bounds));
    found += expected.size();
  }
  EXPECT_GT(found, 300u);
}

TEST_F(ObjectTreeVisit, BoundsMayBeInfinite)
{
  EXPECT_EQ(boxes_.size(), visited({Vector3d::Constant(-kInfinity), Vector3d::Constant(kInfinity)}).size());
  for (int axis = 0; axis < 3; ++axis)
  {
    AlignedBox3d above(Vector3d::Constant(-2.0), Vector3d::Constant(2.0));
    above.min()[axis] = 0.3;
    above.max()[axis] = kInfinity;
    AlignedBox3d below = above;
    below.max()[axis] = 0.3;
    below.min()[axis] = -kInfinity;
    AlignedBox3d column = above;
    column.min()[axis] = -kInfinity;
    column.max()[(axis + 1) % 3] = 0.0;
    for (const AlignedBox3d& bounds : {above, below, column})
    {
      const std::vector<std::uint32_t> expected = overlapping(bounds);
      EXPECT_TRUE(!expected.empty() && expected.size() < boxes_.size());
      EXPECT_EQ(expected, visited(bounds));
    }
  }
}

TEST_F(ObjectTreeVisit, EndsWhenTheVisitorReturnsTrue)
{
  int visits = 0;
  const auto third = [&visits](std::uint32_t) { return ++visits == 3; };
  EXPECT_TRUE(tree_.visitOverlapping({Vector3d::Constant(-2.0), Vector3d::Constant(2.0)}, stack_, third));
  EXPECT_EQ(3, visits);
}

TEST_F(ObjectTreeVisit, AnEmptyTreeHasNothingToVisit)
{
  const auto visit = [](std::uint32_t) { return true; };
  EXPECT_FALSE(
      ObjectTree().visitOverlapping({Vector3d::Constant(-kInfinity), Vector3d::Constant(kInfinity)}, stack_, visit));
}
}  // namespace
}  // namespace gpu_planning_scene::core
