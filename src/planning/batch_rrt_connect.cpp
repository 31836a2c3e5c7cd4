#include "gpu_planning_scene/planning/batch_rrt_connect.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <ompl/geometric/PathGeometric.h>

#include "planning/bulk_validator.h"
#include "planning/two_trees.h"

namespace gpu_planning_scene
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;
using Vertex = RrtTree::Vertex;

// The chosen range, as a part of the largest distance in the space. OMPL's RRTConnect takes a fifth of it; short motions
// need far fewer states for a solution amid obstacles, and motions in bulk make up for their number.
constexpr double kRangeOfExtent = 0.04;

// A round has a random branch for so many vertices. Branches of one round know nothing of each other; while the trees
// are small, many would be wasted.
constexpr std::size_t kVerticesPerBranch = 8;
constexpr std::size_t kLeastBranches = 2;

// Goal states that are taken at once. More of them follow as the goal tree grows, as in OMPL's RRTConnect.
constexpr std::size_t kFirstGoals = 8;

std::shared_ptr<PathGeometric> pathOf(const ob::SpaceInformationPtr& information, const TwoTrees::Meeting& meeting)
{
  std::vector<const ob::State*> states;
  for (const Vertex* vertex = meeting.start; vertex; vertex = vertex->parent)
    states.push_back(vertex->state);
  std::reverse(states.begin(), states.end());
  for (const Vertex* vertex = meeting.goal; vertex; vertex = vertex->parent)
    states.push_back(vertex->state);
  auto path = std::make_shared<PathGeometric>(information);
  for (const ob::State* state : states)
    path->append(state);
  return path;
}
}  // namespace

struct BatchRrtConnect::Progress
{
  explicit Progress(const ob::Planner& planner) : trees(planner) {}

  TwoTrees trees;
  bool is_first_round = true;
  /// Of the last solution. Its goal vertex is null where its start vertex is in the goal region.
  TwoTrees::Meeting meeting{nullptr, nullptr};
  std::size_t looked_at = 0;        // vertices of the start tree whose distance to the goal is known
  const Vertex* closest = nullptr;  // of those
  double distance = std::numeric_limits<double>::infinity();
};

BatchRrtConnect::BatchRrtConnect(const ob::SpaceInformationPtr& information)
  : ob::Planner(information, "BatchRrtConnect")
{
  specs_.recognizedGoal = ob::GOAL_SAMPLEABLE_REGION;
  specs_.directed = true;
  specs_.approximateSolutions = true;
  declareParam<double>("range", this, &BatchRrtConnect::setRange, &BatchRrtConnect::getRange, "0.:1.:10000.");
  declareParam<unsigned int>("branches", this, &BatchRrtConnect::setBranches, &BatchRrtConnect::getBranches,
                             "1:1:1024");
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

void BatchRrtConnect::setup()
{
  Planner::setup();
  bulkValidatorOf(*si_, getName());
  if (range_ <= 0.0)
    range_ = kRangeOfExtent * si_->getMaximumExtent();
}

void BatchRrtConnect::clear()
{
  Planner::clear();
  progress_.reset();
}

/// Null if there is none, or no time. Waits for goals that arrive late, but not where all of them are known.
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

/// EXACT_SOLUTION here means that there are states to begin with.
ob::PlannerStatus BatchRrtConnect::takeInputs(const ob::GoalSampleableRegion& goal,
                                              const ob::PlannerTerminationCondition& ptc)
{
  TwoTrees& trees = progress_->trees;
  while (const ob::State* state = pis_.nextStart())
    trees.addRoot(TwoTrees::Start, state);
  if (trees.tree(TwoTrees::Start).size() == 0)
    return ob::PlannerStatus::INVALID_START;
  if (trees.tree(TwoTrees::Goal).size() != 0)
    return ob::PlannerStatus::EXACT_SOLUTION;
  if (!goal.couldSample())
    return ob::PlannerStatus::INVALID_GOAL;
  const ob::State* state = firstGoal(goal, ptc);
  if (!state)
    // Where goals arrive late, there may have been none yet.
    return goal.couldSample() && pis_.getSampledGoalsCount() == 0 ? ob::PlannerStatus::TIMEOUT
                                                                  : ob::PlannerStatus::INVALID_GOAL;
  trees.addRoot(TwoTrees::Goal, state);
  return ob::PlannerStatus::EXACT_SOLUTION;
}

void BatchRrtConnect::takeMoreGoals()
{
  TwoTrees& trees = progress_->trees;
  const std::size_t wanted = std::max(kFirstGoals, trees.tree(TwoTrees::Goal).size() / 2);
  for (std::size_t i = 0; i < kFirstGoals && pis_.haveMoreGoalStates() && pis_.getSampledGoalsCount() < wanted; ++i)
    if (const ob::State* state = pis_.nextGoal())
      trees.addRoot(TwoTrees::Goal, state);
}

/// Whether there is a solution now.
bool BatchRrtConnect::runRound(const ob::GoalSampleableRegion& goal)
{
  Progress& progress = *progress_;
  // At first nothing but the straight ways.
  const std::size_t size = progress.trees.tree(TwoTrees::Start).size() + progress.trees.tree(TwoTrees::Goal).size();
  const std::size_t branches = std::min<std::size_t>(branches_, std::max(kLeastBranches, size / kVerticesPerBranch));
  std::vector<TwoTrees::Meeting> meetings =
      progress.trees.grow(bulkValidatorOf(*si_, getName()), progress.is_first_round ? 0 : branches, range_);
  progress.is_first_round = false;

  const auto& vertices = progress.trees.tree(TwoTrees::Start).vertices();
  for (; progress.looked_at < vertices.size(); ++progress.looked_at)
  {
    const Vertex& vertex = *vertices[progress.looked_at];
    double distance = 0.0;
    if (goal.isSatisfied(vertex.state, &distance))
      meetings.push_back({&vertex, nullptr});
    if (distance < progress.distance)
    {
      progress.distance = distance;
      progress.closest = &vertex;
    }
  }

  std::shared_ptr<PathGeometric> shortest;
  for (const TwoTrees::Meeting& meeting : meetings)
  {
    const ob::State* end = meeting.goal ? meeting.goal->root().state : meeting.start->state;
    if (!goal.isStartGoalPairValid(meeting.start->root().state, end))
      continue;
    std::shared_ptr<PathGeometric> path = pathOf(si_, meeting);
    if (shortest && path->length() >= shortest->length())
      continue;
    shortest = std::move(path);
    progress.meeting = meeting;
  }
  if (shortest)
    pdef_->addSolutionPath(shortest, false, 0.0, getName());
  return shortest != nullptr;
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
  if (!progress_)
    progress_ = std::make_unique<Progress>(*this);
  if (const ob::PlannerStatus status = takeInputs(*goal, ptc); !status)
  {
    OMPL_ERROR("%s: there is no valid %s state", getName().c_str(),
               status == ob::PlannerStatus::INVALID_START ? "start" : "goal");
    return status;
  }
  while (!ptc)
  {
    takeMoreGoals();
    if (runRound(*goal))
      return ob::PlannerStatus::EXACT_SOLUTION;
  }
  const Vertex* closest = progress_->closest;
  if (!closest || !closest->parent)
    return ob::PlannerStatus::TIMEOUT;
  pdef_->addSolutionPath(pathOf(si_, {closest, nullptr}), true, progress_->distance, getName());
  return ob::PlannerStatus::APPROXIMATE_SOLUTION;
}

void BatchRrtConnect::getPlannerData(ob::PlannerData& data) const
{
  Planner::getPlannerData(data);
  if (!progress_)
    return;
  for (const auto& vertex : progress_->trees.tree(TwoTrees::Start).vertices())
  {
    if (vertex->parent)
      data.addEdge(ob::PlannerDataVertex(vertex->parent->state, 1), ob::PlannerDataVertex(vertex->state, 1));
    else
      data.addStartVertex(ob::PlannerDataVertex(vertex->state, 1));
  }
  for (const auto& vertex : progress_->trees.tree(TwoTrees::Goal).vertices())
  {
    if (vertex->parent)
      data.addEdge(ob::PlannerDataVertex(vertex->state, 2), ob::PlannerDataVertex(vertex->parent->state, 2));
    else
      data.addGoalVertex(ob::PlannerDataVertex(vertex->state, 2));
  }
  const TwoTrees::Meeting& meeting = progress_->meeting;
  if (meeting.goal)
    data.addEdge(ob::PlannerDataVertex(meeting.start->state, 1), ob::PlannerDataVertex(meeting.goal->state, 2));
}
}  // namespace gpu_planning_scene
