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

// The chosen range, as a part of the largest distance in the space. OMPL's RRTConnect takes a fifth of it; short
// motions need far fewer states for a solution amid obstacles, and motions in bulk make up for their number.
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

/// The trees, and what was found with them so far.
class BatchRrtConnect::Search
{
 public:
  explicit Search(const ob::Planner& planner) : information_(planner.getSpaceInformation()), trees_(planner) {}

  TwoTrees& trees() { return trees_; }

  /// A round of the trees. Returns a solution, if there is one.
  std::shared_ptr<PathGeometric> runRound(const MotionValidator& validator, const ob::GoalSampleableRegion& goal,
                                          std::size_t most_branches, double range);

  /// The way to the vertex that is closest to the goal, as far as it is proven; null if that is nothing.
  std::shared_ptr<PathGeometric> approximatePath(const MotionValidator& validator);

  void addTo(ob::PlannerData& data) const;

 private:
  void lookAtNewVertices(const ob::GoalSampleableRegion& goal, std::vector<TwoTrees::Meeting>& meetings);
  bool isProven(const MotionValidator& validator, const TwoTrees::Meeting& meeting);

  ob::SpaceInformationPtr information_;
  TwoTrees trees_;
  bool is_first_round_ = true;
  /// Of the last solution. Its goal vertex is null where its start vertex is in the goal region.
  TwoTrees::Meeting meeting_{nullptr, nullptr};
  std::size_t looked_at_ = 0;        // vertices of the start tree whose distance to the goal is known
  const Vertex* closest_ = nullptr;  // of those
  double distance_ = std::numeric_limits<double>::infinity();
};

/// Finds those that are in the goal region, which may be more than the goal tree's states, and the one closest to it.
void BatchRrtConnect::Search::lookAtNewVertices(const ob::GoalSampleableRegion& goal,
                                                std::vector<TwoTrees::Meeting>& meetings)
{
  if (closest_ && closest_->removed)
  {
    looked_at_ = 0;
    closest_ = nullptr;
    distance_ = std::numeric_limits<double>::infinity();
  }
  const auto& vertices = trees_.tree(TwoTrees::Start).vertices();
  for (; looked_at_ < vertices.size(); ++looked_at_)
  {
    const Vertex& vertex = *vertices[looked_at_];
    if (vertex.removed)
      continue;
    double distance = 0.0;
    if (goal.isSatisfied(vertex.state, &distance))
      meetings.push_back({&vertex, nullptr});
    if (distance < distance_)
    {
      distance_ = distance;
      closest_ = &vertex;
    }
  }
}

/// Whether all motions of the path through a meeting are valid by the validator's own rule. Those that are not are
/// taken out of the trees.
bool BatchRrtConnect::Search::isProven(const MotionValidator& validator, const TwoTrees::Meeting& meeting)
{
  if (validator.rule() == MotionRule::Samples)
    return true;
  std::vector<MotionValidator::Motion> motions;
  std::vector<std::pair<TwoTrees::Side, const Vertex*>> ends;  // of the motions within the trees
  for (const Vertex* vertex = meeting.start; vertex->parent; vertex = vertex->parent)
  {
    motions.emplace_back(vertex->parent->state, vertex->state);
    ends.emplace_back(TwoTrees::Start, vertex);
  }
  for (const Vertex* vertex = meeting.goal; vertex && vertex->parent; vertex = vertex->parent)
  {
    motions.emplace_back(vertex->state, vertex->parent->state);
    ends.emplace_back(TwoTrees::Goal, vertex);
  }
  if (meeting.goal)
    motions.emplace_back(meeting.start->state, meeting.goal->state);
  const std::vector<std::uint8_t> valid = validator.validateMotions(motions);
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (valid[i] == 0)
      trees_.remove(ends[i].first, *ends[i].second);
  return std::find(valid.begin(), valid.end(), 0) == valid.end();
}

std::shared_ptr<PathGeometric> BatchRrtConnect::Search::runRound(const MotionValidator& validator,
                                                                 const ob::GoalSampleableRegion& goal,
                                                                 std::size_t most_branches, double range)
{
  const std::size_t size = trees_.tree(TwoTrees::Start).size() + trees_.tree(TwoTrees::Goal).size();
  const std::size_t branches = std::min(most_branches, std::max(kLeastBranches, size / kVerticesPerBranch));
  // At first nothing but the straight ways.
  std::vector<TwoTrees::Meeting> meetings = trees_.grow(validator, is_first_round_ ? 0 : branches, range);
  is_first_round_ = false;
  lookAtNewVertices(goal, meetings);

  std::vector<std::pair<std::shared_ptr<PathGeometric>, TwoTrees::Meeting>> paths;
  for (const TwoTrees::Meeting& meeting : meetings)
  {
    const ob::State* end = meeting.goal ? meeting.goal->root().state : meeting.start->state;
    if (goal.isStartGoalPairValid(meeting.start->root().state, end))
      paths.emplace_back(pathOf(information_, meeting), meeting);
  }
  std::stable_sort(paths.begin(), paths.end(),
                   [](const auto& a, const auto& b) { return a.first->length() < b.first->length(); });
  for (const auto& [path, meeting] : paths)
  {
    const bool is_there = !meeting.start->removed && !(meeting.goal && meeting.goal->removed);
    if (!is_there || !isProven(validator, meeting))
      continue;
    meeting_ = meeting;
    return path;
  }
  return nullptr;
}

std::shared_ptr<PathGeometric> BatchRrtConnect::Search::approximatePath(const MotionValidator& validator)
{
  while (closest_ && closest_->parent)
  {
    if (isProven(validator, {closest_, nullptr}))
      return pathOf(information_, {closest_, nullptr});
    while (closest_->removed)
      closest_ = closest_->parent;
  }
  return nullptr;
}

void BatchRrtConnect::Search::addTo(ob::PlannerData& data) const
{
  for (const auto& vertex : trees_.tree(TwoTrees::Start).vertices())
  {
    if (vertex->removed)
      continue;
    if (vertex->parent)
      data.addEdge(ob::PlannerDataVertex(vertex->parent->state, 1), ob::PlannerDataVertex(vertex->state, 1));
    else
      data.addStartVertex(ob::PlannerDataVertex(vertex->state, 1));
  }
  for (const auto& vertex : trees_.tree(TwoTrees::Goal).vertices())
  {
    if (vertex->removed)
      continue;
    if (vertex->parent)
      data.addEdge(ob::PlannerDataVertex(vertex->state, 2), ob::PlannerDataVertex(vertex->parent->state, 2));
    else
      data.addGoalVertex(ob::PlannerDataVertex(vertex->state, 2));
  }
  if (meeting_.goal)
    data.addEdge(ob::PlannerDataVertex(meeting_.start->state, 1), ob::PlannerDataVertex(meeting_.goal->state, 2));
}

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
  search_.reset();
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
  TwoTrees& trees = search_->trees();
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
  TwoTrees& trees = search_->trees();
  const std::size_t wanted = std::max(kFirstGoals, trees.tree(TwoTrees::Goal).size() / 2);
  for (std::size_t i = 0; i < kFirstGoals && pis_.haveMoreGoalStates() && pis_.getSampledGoalsCount() < wanted; ++i)
    if (const ob::State* state = pis_.nextGoal())
      trees.addRoot(TwoTrees::Goal, state);
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
    search_ = std::make_unique<Search>(*this);
  if (const ob::PlannerStatus status = takeInputs(*goal, ptc); !status)
  {
    OMPL_ERROR("%s: there is no valid %s state", getName().c_str(),
               status == ob::PlannerStatus::INVALID_START ? "start" : "goal");
    return status;
  }
  const MotionValidator& validator = bulkValidatorOf(*si_, getName());
  while (!ptc)
  {
    takeMoreGoals();
    if (const auto path = search_->runRound(validator, *goal, branches_, range_))
    {
      pdef_->addSolutionPath(path, false, 0.0, getName());
      return ob::PlannerStatus::EXACT_SOLUTION;
    }
  }
  const std::shared_ptr<PathGeometric> path = search_->approximatePath(validator);
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
}  // namespace gpu_planning_scene
