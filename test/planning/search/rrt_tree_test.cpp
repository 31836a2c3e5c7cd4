// The nearest vertex of a tree, also after parts of the tree were removed.

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <ompl/geometric/planners/rrt/RRT.h>

#include "planning/point_robot.h"
#include "planning/search/rrt_tree.h"

namespace gpu_planning_scene::core
{
namespace
{
using Vertex = RrtTree::Vertex;

class Trees : public testing::Test
{
 protected:
  PointRobot::Position random()
  {
    std::uniform_real_distribution<double> any(-2.0, 2.0);
    // Few different values, so that some vertices have equal states.
    return {std::round(10.0 * any(generator_)) / 10.0, any(generator_) < 1.0 ? 0.5 : any(generator_)};
  }

  const Vertex& add(const Vertex* parent) { return tree_.add(robot_.at(random()).get(), parent); }

  const Vertex& any()
  {
    for (;;)
      if (const Vertex& vertex = *tree_.vertices()[generator_() % tree_.size()]; !vertex.removed)
        return vertex;
  }

  /// The distance to the nearest vertex, by brute force.
  double leastDistance(const ompl::base::State* state) const
  {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& vertex : tree_.vertices())
      if (!vertex->removed)
        least = std::min(least, robot_.information()->distance(vertex->state, state));
    return least;
  }

  const std::uint64_t seed_ = std::random_device()();
  std::mt19937_64 generator_{seed_};
  PointRobot robot_{{}};
  ompl::geometric::RRT planner_{robot_.information()};  // provides the space and its distances
  RrtTree tree_{planner_};
};

TEST_F(Trees, FindTheNearestRemainingVertex)
{
  SCOPED_TRACE("seed " + std::to_string(seed_));
  add(nullptr);
  for (int round = 0; round < 40; ++round)
  {
    for (int i = 0; i < 50; ++i)
      add(&any());
    std::vector<const Vertex*> removed;
    for (int i = 0; i < 3; ++i)
      if (const Vertex& vertex = any(); vertex.parent)
        removed.push_back(&vertex);
    tree_.remove(removed);
    for (const auto& vertex : tree_.vertices())
      EXPECT_TRUE(vertex->removed || !vertex->parent || !vertex->parent->removed)
          << "it has grown from what is removed";
    for (const Vertex* vertex : removed)
      EXPECT_TRUE(vertex->removed);
    for (int i = 0; i < 20; ++i)
    {
      const auto state = robot_.at(random());
      const Vertex& nearest = tree_.nearest(state.get());
      EXPECT_FALSE(nearest.removed);
      // Distances of 0.1 differ by their rounding. The nearest-neighbour structure compares sums of them, so it may
      // take any of these vertices.
      EXPECT_NEAR(robot_.information()->distance(nearest.state, state.get()), leastDistance(state.get()), 1e-12);
    }
  }
}
}  // namespace
}  // namespace gpu_planning_scene::core
