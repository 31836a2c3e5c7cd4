#include "planning/goals/goal_regions.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/error_place.h"
#include "gpu_planning_scene/error.h"
#include "planning/space/group_space.h"

// Goals that are sampled while the planner searches, as in the task space regions of D. Berenson, S. Srinivasa, J.
// Kuffner: Task space regions: A framework for pose-constrained manipulation planning. IJRR 30(12), 2011.
namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

// Attempts of a region in one turn. A planner waits for a turn in each of its rounds, so a turn is short. An arm with
// six joints has at most 16 solutions of a pose, and most attempts find one that is known.
constexpr std::size_t kAttemptsOfTurn = 4;

// States and turns for the beginning of a search. The planner samples more in its rounds.
constexpr std::size_t kFirstStates = 8;
constexpr std::size_t kFirstTurns = 4;

// Sampling ends after so many turns in a row without a new state. A region whose states mostly collide needs many.
constexpr std::size_t kMostIdleTurns = 100;

// The states of a region fulfil its constraints before the space wraps their angles, which rounds them.
constexpr double kGoalRounding = 1e-9;

constexpr IkOptions endless(std::uint64_t seed)
{
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  return {kMost, kMost, IkOptions().least_difference, seed};
}
}  // namespace

struct GoalRegions::Region
{
  Region(const std::shared_ptr<const RobotModel>& robot, const std::string& group, const KinematicConstraints& region,
         const std::vector<double>& start, std::uint64_t seed)
    : kinematics(robot, group, region), search(kinematics, start.data(), endless(seed))
  {
  }

  InverseKinematics kinematics;
  IkSearch search;
  std::size_t colliding = 0;
  BodyPair collision = kNoPair;  // of the first candidate that collides
  bool is_outside = false;       // a candidate was outside the bounds of the space
};

GoalRegions::GoalRegions(const ob::SpaceInformationPtr& information, std::shared_ptr<const PlanningScene> scene,
                         std::shared_ptr<StateChecker> checker, const std::vector<KinematicConstraints>& regions,
                         const std::vector<double>& start, const std::vector<ob::ScopedState<>>& states,
                         std::uint64_t seed)
  : ob::GoalSampleableRegion(information),
    scene_(std::move(scene)),
    checker_(std::move(checker)),
    space_(groupSpaceOf(*information, *scene_)),
    start_(start),
    fixed_(states)
{
  setThreshold(kGoalRounding);
  for (std::size_t i = 0; i < regions.size(); ++i)
  {
    const auto add = [&]
    { regions_.push_back(std::make_unique<Region>(scene_->robot, space_->group().name, regions[i], start, seed + i)); };
    if (regions.size() == 1)
      add();
    else
      withErrorPlace("goal region " + std::to_string(i), add);
  }
  for (const ob::ScopedState<>& state : states)
    states_.push_back(information->cloneState(state.get()));
}

GoalRegions::~GoalRegions()
{
  for (ob::State* state : states_)
    si_->freeState(state);
}

bool GoalRegions::prepare(const std::function<bool()>& stop)
{
  for (std::size_t turn = 0; idle_ < kMostIdleTurns && !(stop && stop()); ++turn)
  {
    if (states_.size() >= kFirstStates || (turn >= kFirstTurns && !states_.empty()))
      break;
    sample(stop);
  }
  return !states_.empty();
}

/// One turn: candidates of each region, checked in one batch.
void GoalRegions::sample(const std::function<bool()>& stop) const
{
  const std::size_t before = states_.size();
  for (const auto& region : regions_)
  {
    std::vector<std::vector<double>> candidates;
    const std::size_t last = region->search.attempts() + kAttemptsOfTurn;
    const auto is_over = [&] { return region->search.attempts() >= last || (stop && stop()); };
    while (auto candidate = region->search.next(is_over))
      candidates.push_back(std::move(*candidate));
    judge(*region, candidates);
  }
  idle_ = states_.size() == before ? idle_ + 1 : 0;
}

/// Adds the candidates that are free and within the bounds.
void GoalRegions::judge(Region& region, const std::vector<std::vector<double>>& candidates) const
{
  if (candidates.empty())
    return;
  std::vector<double> rows;
  for (const std::vector<double>& candidate : candidates)
    rows.insert(rows.end(), candidate.begin(), candidate.end());
  const BatchResult checked = checker_->check(rows.data(), candidates.size(), space_->group().name);
  for (std::size_t i = 0; i < candidates.size(); ++i)
  {
    if (checked.valid[i] == 0)
    {
      if (++region.colliding == 1)
        region.collision = checked.colliding[i];
      continue;
    }
    ob::State* state = si_->allocState();
    space_->copyFromRow(candidates[i].data(), state);
    if (isWithin(*space_, state))
    {
      states_.push_back(state);
      continue;
    }
    region.is_outside = true;
    si_->freeState(state);
  }
}

std::string GoalRegions::fault(const std::string& name, bool& in_collision) const
{
  in_collision =
      std::any_of(regions_.begin(), regions_.end(), [](const auto& region) { return region->colliding != 0; });
  std::string text;
  for (std::size_t i = 0; i < regions_.size(); ++i)
  {
    Region& region = *regions_[i];
    text +=
        (text.empty() ? "" : "; ") + (regions_.size() == 1 ? "the " + name : "goal region " + std::to_string(i)) + " ";
    if (region.colliding != 0)
      text += "is in collision: in the first of " + std::to_string(region.colliding) + " states, " +
              scene_->bodyName(region.collision[0]) + " and " + scene_->bodyName(region.collision[1]) + " collide";
    else if (region.is_outside)
      text += "is only reached out of bounds";
    else if (region.search.nearest().empty())
      text += "was not reached before the search was stopped";
    else
      text += "is not reached: the nearest of " + std::to_string(region.search.attempts()) + " attempts is " +
              region.kinematics.violation(region.search.nearest().data()).text();
  }
  return text;
}

void GoalRegions::sampleGoal(ob::State* state) const
{
  if (next_ == states_.size())
    next_ = 0;  // another planner begins
  si_->copyState(state, states_[next_++]);
}

unsigned int GoalRegions::maxSampleCount() const
{
  if (next_ == states_.size() && idle_ < kMostIdleTurns)
    sample({});
  return static_cast<unsigned int>(states_.size());
}

double GoalRegions::distanceGoal(const ob::State* state) const
{
  double least = std::numeric_limits<double>::infinity();
  for (const ob::ScopedState<>& goal : fixed_)
    least = std::min(least, si_->distance(state, goal.get()));
  std::vector<double> row = start_;
  space_->copyToRow(state, row.data());
  for (const auto& region : regions_)
    least = std::min(least, region->kinematics.violation(row.data()).sum());
  return least;
}
}  // namespace gpu_planning_scene::core
