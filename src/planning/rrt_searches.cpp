#include "planning/rrt_searches.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <utility>

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
  searches_.push_back(std::make_unique<RrtSearch>(planner));
}

void RrtSearches::addSearches(std::size_t count)
{
  while (searches_.size() < count)
  {
    searches_.push_back(std::make_unique<RrtSearch>(planner_));
    for (const BidirectionalTree::Side side : {BidirectionalTree::Start, BidirectionalTree::Goal})
      for (const ob::State* root : first().trees().roots(side))
        searches_.back()->trees().addRoot(side, root);
  }
}

RrtSearch::Path RrtSearches::run(const MotionValidator& validator, const ob::GoalSampleableRegion& goal,
                                 const Options& options, const std::function<void()>& before_round,
                                 const ob::PlannerTerminationCondition& ptc)
{
  solver_ = 0;
  const std::size_t alone = options.count > 1 && searches_.size() > 1 ? 0 : kRoundsAlone;
  std::size_t rounds = 0;
  const auto is_over = [&] { return ptc || (options.max_rounds != 0 && rounds == options.max_rounds); };
  for (; options.count == 1 || rounds < alone; ++rounds)
  {
    if (is_over())
      return nullptr;
    before_round();
    if (RrtSearch::Path path = first().runRound(validator, goal, options.limits, ptc))
      return path;
  }
  if (is_over())
    return nullptr;
  return runBesideOthers(validator, goal, options, rounds, before_round, ptc);
}

/// `rounds`: of the first search so far.
RrtSearch::Path RrtSearches::runBesideOthers(const MotionValidator& validator, const ob::GoalSampleableRegion& goal,
                                             const Options& options, std::size_t rounds,
                                             const std::function<void()>& before_round,
                                             const ob::PlannerTerminationCondition& ptc)
{
  addSearches(options.count);
  std::vector<RrtSearch::Path> paths(options.count);
  std::vector<std::exception_ptr> errors(options.count);
  std::atomic<bool> has_ended{false};
  // Only the calling thread asks `ptc`, which need not be thread-safe.
  const ob::PlannerTerminationCondition end_of_others([&has_ended] { return has_ended.load(); });
  const auto end_of_first = ob::plannerOrTerminationCondition(ptc, end_of_others);
  const auto run_other = [&](std::size_t i)
  {
    try
    {
      while (!paths[i] && !has_ended)
        paths[i] = searches_[i]->runRound(validator, goal, options.limits, end_of_others);
    }
    catch (...)
    {
      errors[i] = std::current_exception();
    }
    has_ended = true;
  };
  const auto run_first = [&]
  {
    try
    {
      for (; !paths[0] && !end_of_first && (options.max_rounds == 0 || rounds < options.max_rounds); ++rounds)
      {
        before_round();
        paths[0] = first().runRound(validator, goal, options.limits, end_of_first);
      }
    }
    catch (...)
    {
      errors[0] = std::current_exception();
    }
    has_ended = true;
  };
  std::vector<std::thread> threads;
  threads.reserve(options.count);
  try
  {
    for (std::size_t i = 1; i < options.count; ++i)
      threads.emplace_back(run_other, i);
  }
  catch (const std::exception&)
  {
    // No thread, or no memory for one. The searches that have begun go on: destroying a running std::thread ends the
    // process.
  }
  run_first();
  for (std::thread& thread : threads)
    thread.join();
  for (const std::exception_ptr& error : errors)
    if (error)
      std::rethrow_exception(error);
  const auto found =
      std::find_if(paths.begin(), paths.end(), [](const RrtSearch::Path& path) { return path != nullptr; });
  if (found == paths.end())
    return nullptr;
  solver_ = static_cast<std::size_t>(found - paths.begin());
  return *found;
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
