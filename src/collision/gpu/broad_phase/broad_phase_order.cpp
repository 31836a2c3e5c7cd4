#include "collision/gpu/broad_phase/broad_phase_order.h"

#include <algorithm>

#include "shader_constants.h"

// Counts the reported collisions per query and sorts the queries by these counts. A new order is due when the number of
// states has doubled, and at least every kMaxStatesPerOrder states. This is the rule of ExactChecker::learnOrder (Simon
// and Kadane 1975) for queries of equal cost.
namespace gpu_planning_scene::core
{
namespace
{
/// The first queries of each kind (self, world) run before all other queries. They have this share of the hits of their
/// kind.
constexpr double kHotShare = 0.9;
constexpr std::size_t kMaxStatesPerOrder = std::size_t{1} << 20U;

std::uint64_t keyOf(std::uint32_t low, std::uint32_t high)
{
  return std::uint64_t{low} << 32U | high;
}

void rank(std::vector<RankedQuery>& queries)
{
  std::stable_sort(
      queries.begin(), queries.end(), [](const RankedQuery& a, const RankedQuery& b) { return a.hits > b.hits; });
}

/// The number of first queries that together have kHotShare of all hits.
std::uint32_t hotCount(const std::vector<RankedQuery>& queries)
{
  std::uint64_t all = 0;
  for (const RankedQuery& query : queries)
    all += query.hits;
  std::uint64_t some = 0;
  std::uint32_t count = 0;
  while (static_cast<double>(some) < kHotShare * static_cast<double>(all))
    some += queries[count++].hits;
  return count;
}
}  // namespace

void BroadPhaseOrder::setPairs(const CollisionProblem& problem)
{
  const auto width = static_cast<std::ptrdiff_t>(problem.world.size());
  meets_world_.assign(problem.robot.size(), 0);
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
  {
    const auto row = problem.world_pairs.begin() + static_cast<std::ptrdiff_t>(i) * width;
    const auto planes = problem.half_space_pairs.begin() + static_cast<std::ptrdiff_t>(i * problem.half_spaces.size());
    const auto planes_end = planes + static_cast<std::ptrdiff_t>(problem.half_spaces.size());
    meets_world_[i] = std::find(row, row + width, std::uint8_t{1}) != row + width ||
                      std::find(planes, planes_end, std::uint8_t{1}) != planes_end;
  }
  if (problem.robot.size() == world_hits_.size() && hasPairs(problem.self_pairs))
    return;
  world_hits_.assign(problem.robot.size(), 0);
  pairs_.clear();
  pair_of_.clear();
  for (const auto& pair : problem.self_pairs)
  {
    const Pair made{std::min(pair[0], pair[1]), std::max(pair[0], pair[1])};
    pair_of_.emplace(keyOf(made.low, made.high), static_cast<std::uint32_t>(pairs_.size()));
    pairs_.push_back(made);
  }
  states_ = 0;
  next_order_ = 1;
}

bool BroadPhaseOrder::hasPairs(const std::vector<InstancePair>& pairs) const
{
  return std::equal(
      pairs.begin(), pairs.end(), pairs_.begin(), pairs_.end(),
      [](const InstancePair& pair, const Pair& mine)
      { return std::min(pair[0], pair[1]) == mine.low && std::max(pair[0], pair[1]) == mine.high; });
}

void BroadPhaseOrder::count(std::uint32_t robot, std::uint32_t other)
{
  if (robot < world_hits_.size() && other >= world_hits_.size())
    ++world_hits_[robot];
  else if (const auto pair = pair_of_.find(keyOf(std::min(robot, other), std::max(robot, other)));
           pair != pair_of_.end())
    ++pairs_[pair->second].hits;
}

bool BroadPhaseOrder::endBatch(std::size_t states)
{
  states_ += states;
  if (states_ < next_order_)
    return false;
  next_order_ = states_ + std::min(states_, kMaxStatesPerOrder);
  return true;
}

std::vector<RankedQuery> BroadPhaseOrder::worldQueries() const
{
  std::vector<RankedQuery> queries;
  for (std::uint32_t i = 0; i < meets_world_.size(); ++i)
    if (meets_world_[i])
      queries.push_back({{i, 0, 0, 0}, world_hits_[i]});
  rank(queries);
  return queries;
}

/// Sorts the pairs of each instance by their hits, and puts up to QUERY_PARTNERS of them into one query.
std::vector<RankedQuery> BroadPhaseOrder::selfQueries() const
{
  std::vector<Pair> pairs = pairs_;
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& a, const Pair& b)
            {
              if (a.low != b.low)
                return a.low < b.low;
              return a.hits != b.hits ? a.hits > b.hits : a.high < b.high;
            });
  std::vector<RankedQuery> queries;
  std::uint32_t room = 0;
  for (const Pair& pair : pairs)
  {
    if (room == 0 || queries.back().record[0] != pair.low)
    {
      constexpr std::uint32_t kNone = NO_PARTNER | NO_PARTNER << 16U;
      queries.push_back({{pair.low, kNone, kNone, kNone}, 0});
      room = QUERY_PARTNERS;
    }
    const std::uint32_t place = QUERY_PARTNERS - room--;
    std::uint32_t& word = queries.back().record[1 + place / 2];
    word = place % 2 == 0 ? (word & 0xffff0000U) | pair.high : (word & 0xffffU) | pair.high << 16U;
    queries.back().hits += pair.hits;
  }
  rank(queries);
  return queries;
}

BroadPhaseQueries BroadPhaseOrder::queries() const
{
  BroadPhaseQueries result;
  const std::vector<RankedQuery> world = worldQueries();
  const std::vector<RankedQuery> self = selfQueries();
  for (const RankedQuery& query : world)
    result.world.push_back(query.record);
  for (const RankedQuery& query : self)
    result.self.push_back(query.record);
  result.hot_world = hotCount(world);
  result.hot_self = hotCount(self);
  return result;
}
}  // namespace gpu_planning_scene::core
