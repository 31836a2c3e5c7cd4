#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "collision/problem/collision_problem.h"

namespace gpu_planning_scene::core
{
/// The queries of the broad phase, as shaders/broad_phase/queries.glsl reads them.
struct BroadPhaseQueries
{
  using Record = std::array<std::uint32_t, 4>;
  std::vector<Record> world;    ///< for what is near a robot instance
  std::vector<Record> self;     ///< for robot instances near another
  std::uint32_t hot_world = 0;  ///< the first ones, which come before the rest of the other kind
  std::uint32_t hot_self = 0;
};

/// A query, and how often it has found a collision.
struct RankedQuery
{
  BroadPhaseQueries::Record record;
  std::uint64_t hits;
};

/// The order in which the broad phase queries, learned from the hits of earlier batches: what collides most often
/// comes first, and spares its states the rest. It changes no answer but which of several colliding pairs is reported.
class BroadPhaseOrder
{
 public:
  /// Sets the checked pairs. What was learned of a robot's pairs stays while they are the same.
  void setPairs(const CollisionProblem& problem);

  /// Counts a hit of a robot instance with another, or with (number of robot instances + an instance of the world).
  void count(std::uint32_t robot, std::uint32_t other);

  /// Ends a batch of so many states, whose hits were counted. Whether there is enough that is new for another order.
  bool endBatch(std::size_t states);

  BroadPhaseQueries queries() const;

 private:
  struct Pair
  {
    std::uint32_t low;  // robot instances
    std::uint32_t high;
    std::uint64_t hits = 0;
  };
  bool hasPairs(const std::vector<std::array<std::uint32_t, 2>>& pairs) const;
  std::vector<RankedQuery> worldQueries() const;
  std::vector<RankedQuery> selfQueries() const;

  std::vector<std::uint8_t> meets_world_;  // by robot instance
  std::vector<std::uint64_t> world_hits_;  // likewise
  std::vector<Pair> pairs_;
  std::unordered_map<std::uint64_t, std::uint32_t> pair_of_;  // low and high to their place
  std::size_t states_ = 0;                                    // since the pairs were set
  std::size_t next_order_ = 1;                                // due after so many
};
}  // namespace gpu_planning_scene::core
