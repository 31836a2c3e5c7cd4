#include "planning/search/rrt_searches.h"

#include <algorithm>

#include "planning/search/other_searches.h"

namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

// Most problems are solved within these rounds of the first search. The other searches begin after them, because
// starting a thread takes as long as a short round.
constexpr std::size_t kRoundsAlone = 6;
}  // namespace

RrtSearches::RrtSearches(const ob::Planner& planner) : planner_(planner)
{
  searches_.push_back(std::make_unique<RrtSearch>(planner, proofs_));
}

void RrtSearches::addSearches(std::size_t count)
{
  while (searches_.size() < count)
  {
    searches_.push_back(std::make_unique<RrtSearch>(planner_, proofs_));
    for (const BidirectionalTree::Side side : {BidirectionalTree::Start, BidirectionalTree::Goal})
      for (const ob::State* root : first().trees().roots(side))
        searches_.back()->trees().addRoot(side, root);
  }
}

RrtSearch::Path RrtSearches::run(const MotionValidator& validator, const ob::GoalSampleableRegion& goal,
                                 const Options& options, const std::function<void()>& before_round,
                                 const ob::PlannerTerminationCondition& ptc)
{
  OtherSearches others;
  // The other searches do not ask `ptc`, which need not be thread-safe.
  const auto end = ob::plannerOrTerminationCondition(ptc, others.hasEnded());
  const std::size_t alone = searches_.size() > 1 ? 0 : kRoundsAlone;
  solver_ = 0;
  RrtSearch::Path path;
  for (std::size_t round = 0; !path && !end && (options.max_rounds == 0 || round < options.max_rounds); ++round)
  {
    if (round == alone && options.count > 1)
    {
      addSearches(options.count);
      others.start(options.count, [&](std::size_t search, const ob::PlannerTerminationCondition& end_of_others)
                   { return searches_[search]->runRound(validator, goal, options.limits, end_of_others); });
    }
    before_round();
    path = first().runRound(validator, goal, options.limits, end);
    if (!path && round == 0 && !end)
      path = first().followPaths(validator, goal, options.known_paths, options.limits.range, end);
  }
  others.end();
  const OtherSearches::Solution other = others.solution();
  if (path || !other.path)
    return path;
  solver_ = other.search;
  return other.path;
}

RrtSearch::Path RrtSearches::provenPath(const MotionValidator& validator, const ob::PlannerTerminationCondition& ptc)
{
  for (std::size_t i = 0; i < searches_.size(); ++i)
    if (RrtSearch::Path path = searches_[i]->provenPath(validator, ptc))
    {
      solver_ = i;
      return path;
    }
  return nullptr;
}

RrtSearch::Path RrtSearches::approximatePath(const MotionValidator& validator,
                                             const ob::PlannerTerminationCondition& ptc)
{
  const auto closest =
      std::min_element(searches_.begin(), searches_.end(),
                       [](const auto& a, const auto& b) { return a->distanceToGoal() < b->distanceToGoal(); });
  solver_ = static_cast<std::size_t>(closest - searches_.begin());
  return (*closest)->approximatePath(validator, ptc);
}
}  // namespace gpu_planning_scene::core
