#include "gpu_planning_scene/planning/batch_rrt_connect.h"

#include <algorithm>
#include <string>
#include <utility>

#include <ompl/util/Time.h>

#include "base/available_cores.h"
#include "planning/search/rrt_searches.h"
#include "planning/validity/bulk_validator.h"

// RRT-Connect that checks motions in batches: OMPL's interface, the inputs and the time. RrtSearches,
// RrtSearch and BidirectionalTree grow the trees. J. J. Kuffner, S. M. LaValle: RRT-Connect: An efficient approach to
// single-query path planning. ICRA 2000.
namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

// The chosen range, as a fraction of the space's extent. OMPL's RRTConnect uses a fifth. Amid obstacles, trees of short
// motions find a solution with far fewer checked states. They need more motions, but checks in bulk make these cheap.
constexpr double kRangeOfExtent = 0.04;

// The same under path constraints. The distance by which a straight motion leaves them grows with the square of its
// length.
constexpr double kConstrainedRange = 0.01;

// Number of goal states taken at first, and at most in one round. More follow as the goal tree grows, as in OMPL's
// RRTConnect.
constexpr std::size_t kFirstGoals = 8;

// Extra time after the end of planning, to prove a path: a fraction of the time so far, within two bounds (seconds).
constexpr double kProofOfTime = 0.1;
constexpr double kLeastProof = 0.1;
constexpr double kMaxProof = 1.0;

// More searches hardly shorten the time of the fastest one, and all of them read the same memory.
constexpr std::size_t kDefaultSearches = 8;
constexpr std::size_t kMostSearches = 64;  // more would only be a mistake
}  // namespace

BatchRrtConnect::BatchRrtConnect(const ob::SpaceInformationPtr& information)
  : ob::Planner(information, "BatchRrtConnect")
{
  specs_.recognizedGoal = ob::GOAL_SAMPLEABLE_REGION;
  specs_.directed = true;
  specs_.approximateSolutions = true;
  declareParam<double>("range", this, &BatchRrtConnect::setRange, &BatchRrtConnect::getRange, "0.:1.:10000.");
  declareParam<unsigned int>("branches", this, &BatchRrtConnect::setBranches, &BatchRrtConnect::getBranches,
                             "1:1:1024");
  declareParam<unsigned int>("searches", this, &BatchRrtConnect::setSearches, &BatchRrtConnect::getSearches, "0:1:64");
  declareParam<unsigned int>("max_rounds", this, &BatchRrtConnect::setMaxRounds, &BatchRrtConnect::getMaxRounds,
                             "0:1:1000000");
}

BatchRrtConnect::~BatchRrtConnect() = default;

void BatchRrtConnect::setRange(double range)
{
  range_ = range;
  setup_ = false;
}

void BatchRrtConnect::setBranches(unsigned int branches)
{
  branches_ = std::max(1U, branches);
}

void BatchRrtConnect::setSearches(unsigned int searches)
{
  if (searches > kMostSearches)
    throw ompl::Exception(
        getName(), "searches is " + std::to_string(searches) + "; it must be at most " + std::to_string(kMostSearches));
  searches_ = searches;
}

void BatchRrtConnect::setup()
{
  Planner::setup();
  const MotionValidator& validator = bulkValidatorOf(*si_, getName().c_str());
  if (range_ <= 0.0)
    range_ = (validator.isConstrained() ? kConstrainedRange : kRangeOfExtent) * si_->getMaximumExtent();
}

void BatchRrtConnect::clear()
{
  Planner::clear();
  search_.reset();
}

/// Returns null if there is no goal state, or no time. Waits for goals that arrive late, unless all goals are known.
const ob::State* BatchRrtConnect::firstGoal(const ob::GoalSampleableRegion& goal,
                                            const ob::PlannerTerminationCondition& ptc)
{
  if (goal.getType() != ob::GOAL_STATE && goal.getType() != ob::GOAL_STATES)
    return pis_.nextGoal(ptc);
  while (pis_.haveMoreGoalStates())
    if (const ob::State* state = pis_.nextGoal())
      return state;
  return nullptr;
}

/// Adds the first start and goal states to the trees. EXACT_SOLUTION means here that both trees have states.
ob::PlannerStatus BatchRrtConnect::takeInputs(const ob::GoalSampleableRegion& goal,
                                              const ob::PlannerTerminationCondition& ptc)
{
  BidirectionalTree& trees = search_->first().trees();
  while (const ob::State* state = pis_.nextStart())
    trees.addRoot(BidirectionalTree::Start, state);
  if (trees.tree(BidirectionalTree::Start).size() == 0)
    return ob::PlannerStatus::INVALID_START;
  if (trees.tree(BidirectionalTree::Goal).size() != 0)
    return ob::PlannerStatus::EXACT_SOLUTION;
  if (!goal.couldSample())
    return ob::PlannerStatus::INVALID_GOAL;
  const ob::State* state = firstGoal(goal, ptc);
  if (!state)
    // The states of the goal region may arrive late.
    return goal.couldSample() && pis_.getSampledGoalsCount() == 0 ? ob::PlannerStatus::TIMEOUT
                                                                  : ob::PlannerStatus::INVALID_GOAL;
  trees.addRoot(BidirectionalTree::Goal, state);
  return ob::PlannerStatus::EXACT_SOLUTION;
}

void BatchRrtConnect::takeMoreGoals()
{
  BidirectionalTree& trees = search_->first().trees();
  const std::size_t wanted = std::max(kFirstGoals, trees.tree(BidirectionalTree::Goal).size() / 2);
  for (std::size_t i = 0; i < kFirstGoals && pis_.haveMoreGoalStates() && pis_.getSampledGoalsCount() < wanted; ++i)
    if (const ob::State* state = pis_.nextGoal())
      trees.addRoot(BidirectionalTree::Goal, state);
}

std::size_t BatchRrtConnect::searchesOf(const MotionValidator& validator) const
{
  if (searches_ != 0)
    return searches_;
  return validator.checksSideBySide() ? std::min(availableCores(), kDefaultSearches) : 1;
}

ob::PlannerStatus BatchRrtConnect::solve(const ob::PlannerTerminationCondition& ptc)
{
  checkValidity();
  const auto* goal = dynamic_cast<const ob::GoalSampleableRegion*>(pdef_->getGoal().get());
  if (!goal)
  {
    OMPL_ERROR("%s: the goal cannot be sampled", getName().c_str());
    return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
  }
  if (!search_)
    search_ = std::make_unique<RrtSearches>(*this);
  if (const ob::PlannerStatus status = takeInputs(*goal, ptc); !status)
  {
    OMPL_ERROR("%s: there is no valid %s state", getName().c_str(),
               status == ob::PlannerStatus::INVALID_START ? "start" : "goal");
    return status;
  }
  const MotionValidator& validator = bulkValidatorOf(*si_, getName().c_str());
  const ompl::time::point start = ompl::time::now();
  const RrtSearches::Options options{
      searchesOf(validator), max_rounds_, {branches_, range_, largest_length_}, std::exchange(known_paths_, {})};
  RrtSearch::Path path = search_->run(
      validator, *goal, options, [this] { takeMoreGoals(); }, ptc);
  const double spent = ompl::time::seconds(ompl::time::now() - start);
  const double more = std::clamp(kProofOfTime * spent, kLeastProof, kMaxProof);
  if (!path && !is_exact_only_)
    path = search_->provenPath(validator, ob::timedPlannerTerminationCondition(more));
  if (path)
  {
    pdef_->addSolutionPath(path, false, 0.0, getName());
    return ob::PlannerStatus::EXACT_SOLUTION;
  }
  if (is_exact_only_)
    return ob::PlannerStatus::TIMEOUT;
  path = search_->approximatePath(validator, ob::timedPlannerTerminationCondition(more));
  if (!path)
    return ob::PlannerStatus::TIMEOUT;
  double distance = 0.0;
  goal->isSatisfied(path->getStates().back(), &distance);
  pdef_->addSolutionPath(path, true, distance, getName());
  return ob::PlannerStatus::APPROXIMATE_SOLUTION;
}

void BatchRrtConnect::getPlannerData(ob::PlannerData& data) const
{
  Planner::getPlannerData(data);
  if (search_)
    search_->addTo(data);
}
}  // namespace gpu_planning_scene::core
