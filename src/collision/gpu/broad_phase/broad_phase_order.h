#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// The queries of the broad phase in the layout of shaders/broad_phase/queries.glsl.
struct BroadPhaseQueries
{
  using Record = std::array<std::uint32_t, 4>;
  std::vector<Record> world;    ///< each finds the world instances near a robot instance
  std::vector<Record> self;     ///< each finds the robot instances near a robot instance
  std::uint32_t hot_world = 0;  ///< number of first `world` queries, which run before the rest of `self`
  /// Number of first `self` queries, which run before all `world` queries.
  std::uint32_t hot_self = 0;
};

/// A query and the number of collisions that it has found.
struct RankedQuery
{
  BroadPhaseQueries::Record record;
  std::uint64_t hits;
};

/// Learns the order of the broad phase's queries from the hits of earlier batches. The queries with the most hits run
/// first; a state that collides there needs no further queries. The order affects only which of several colliding pairs
/// is reported.
class BroadPhaseOrder
{
 public:
  /// Sets the checked pairs. The learned order is kept while the robot's pairs are the same.
  void setPairs(const CollisionProblem& problem);

  /// Counts a hit of a robot instance. `other` is another robot instance, or the number of robot instances plus the
  /// index of a world instance.
  void count(std::uint32_t robot, std::uint32_t other);

  /// Ends a batch of `states` states whose hits were counted. Returns whether enough states have been checked for a new
  /// order.
  bool endBatch(std::size_t states);

  BroadPhaseQueries queries() const;

 private:
  struct Pair
  {
    std::uint32_t low;  // the smaller index of the two robot instances
    std::uint32_t high;
    std::uint64_t hits = 0;
  };
  bool hasPairs(const std::vector<InstancePair>& pairs) const;
  std::vector<RankedQuery> worldQueries() const;
  std::vector<RankedQuery> selfQueries() const;

  std::vector<std::uint8_t> meets_world_;  // by robot instance: 1 if it is in a pair with the world
  std::vector<std::uint64_t> world_hits_;  // hits in the world, by robot instance
  std::vector<Pair> pairs_;
  std::unordered_map<std::uint64_t, std::uint32_t> pair_of_;  // key: low and high; value: index into pairs_
  std::size_t states_ = 0;                                    // states checked since the pairs were set
  std::size_t next_order_ = 1;                                // number of states after which a new order is due
};
}  // namespace gpu_planning_scene::core
