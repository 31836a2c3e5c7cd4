// The order of the broad phase's queries is learned from hits. It contains every checked pair once.

#include <set>

#include <gtest/gtest.h>

#include "collision/gpu/broad_phase/broad_phase_order.h"
#include "shader_constants.h"

namespace gpu_planning_scene::core
{
namespace
{
using Pair = std::array<std::uint32_t, 2>;

/// Robot instances with all self pairs, and one object. All instances but the last are checked with the object.
CollisionProblem problemOf(std::uint32_t instances)
{
  CollisionProblem problem;
  problem.robot.resize(instances);
  problem.world.resize(1);
  problem.world_pairs.assign(instances, 1);
  problem.world_pairs.back() = 0;
  for (std::uint32_t a = 0; a < instances; ++a)
    for (std::uint32_t b = a + 1; b < instances; ++b)
      problem.self_pairs.push_back({b, a});
  return problem;
}

std::vector<Pair> pairsOf(const std::vector<BroadPhaseQueries::Record>& queries)
{
  std::vector<Pair> pairs;
  for (const BroadPhaseQueries::Record& query : queries)
    for (std::uint32_t i = 0; i < QUERY_PARTNERS; ++i)
      if (const std::uint32_t partner = query[1 + i / 2] >> (16U * (i % 2)) & 0xffffU; partner != NO_PARTNER)
        pairs.push_back({query[0], partner});
  return pairs;
}

TEST(BroadPhaseOrder, HasEveryPairOnceWhateverWasLearned)
{
  constexpr std::uint32_t kInstances = 20;
  BroadPhaseOrder order;
  order.setPairs(problemOf(kInstances));
  for (int round = 0; round < 2; ++round)
  {
    const BroadPhaseQueries queries = order.queries();
    EXPECT_EQ(queries.world.size(), std::size_t{kInstances - 1});
    const std::vector<Pair> pairs = pairsOf(queries.self);
    EXPECT_EQ(pairs.size(), std::size_t{kInstances * (kInstances - 1) / 2});
    EXPECT_EQ(std::set<Pair>(pairs.begin(), pairs.end()).size(), pairs.size());
    for (const Pair& pair : pairs)
      EXPECT_LT(pair[0], pair[1]);
    EXPECT_LE(queries.hot_world, queries.world.size());
    EXPECT_LE(queries.hot_self, queries.self.size());
    for (std::uint32_t i = 0; i < 100; ++i)
    {
      order.count(i % 7, 7 + i % 5);
      order.count(12, kInstances);
    }
  }
}

TEST(BroadPhaseOrder, BeginsWithWhatCollidesMostOften)
{
  BroadPhaseOrder order;
  order.setPairs(problemOf(12));
  EXPECT_EQ(order.queries().hot_self, 0U);
  EXPECT_EQ(order.queries().hot_world, 0U);
  // The two instances of a hit may be in either order. The numbers after the robot are an object and then a half-space.
  for (int i = 0; i < 10; ++i)
    order.count(9, 4);
  order.count(0, 1);
  order.count(5, 12);
  order.count(5, 13);
  order.count(3, 12);
  const BroadPhaseQueries queries = order.queries();
  EXPECT_EQ(pairsOf(queries.self).front(), (Pair{4, 9}));
  EXPECT_EQ(queries.hot_self, 1U);
  EXPECT_EQ(queries.world[0][0], 5U);
  EXPECT_EQ(queries.world[1][0], 3U);
  EXPECT_EQ(queries.hot_world, 2U);
}

TEST(BroadPhaseOrder, StaysWhereOnlyTheWorldChanges)
{
  BroadPhaseOrder order;
  CollisionProblem problem = problemOf(12);
  order.setPairs(problem);
  order.count(9, 4);
  order.count(3, 12);
  problem.world.resize(3);
  problem.world_pairs.assign(std::size_t{36}, 0);
  problem.world_pairs[3 * 3 + 1] = 1;
  problem.world_pairs[2 * 3 + 2] = 1;
  order.setPairs(problem);
  BroadPhaseQueries queries = order.queries();
  EXPECT_EQ(pairsOf(queries.self).front(), (Pair{4, 9}));
  ASSERT_EQ(queries.world.size(), 2U);
  EXPECT_EQ(queries.world[0][0], 3U);
  // After a change of the self pairs, everything is learned again.
  problem.self_pairs.pop_back();
  order.setPairs(problem);
  queries = order.queries();
  EXPECT_EQ(pairsOf(queries.self).front(), (Pair{0, 1}));
  EXPECT_EQ(queries.hot_self, 0U);
}

TEST(BroadPhaseOrder, IsDueMoreAndMoreSeldom)
{
  BroadPhaseOrder order;
  order.setPairs(problemOf(3));
  std::size_t due = 0;
  for (int batch = 0; batch < 1000; ++batch)
    due += order.endBatch(64) ? 1 : 0;
  EXPECT_GE(due, 8U);
  EXPECT_LE(due, 12U);
}
}  // namespace
}  // namespace gpu_planning_scene::core
