#include "planning/search/rrt_search.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/finally.h"
#include "planning/search/known_routes.h"

// The trees grow by motions that are checked coarsely. The search proves only the motions of a path that it has found.
// If a motion of the path fails, it is removed from its tree, and the search goes on. This delay of expensive checks is
// the idea of G. Sanchez, J.-C. Latombe: A single-query bi-directional probabilistic roadmap planner with lazy
// collision checking. ISRR 2001. The trees: see bidirectional_tree.h.
namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;
using ompl::geometric::PathGeometric;

// A search that waits for the proof of another one asks this often whether it is to end.
constexpr std::chrono::milliseconds kLookAtEnd{1};

/// The vertices from the root to `vertex`.
std::vector<const RrtTree::Vertex*> branchTo(const RrtTree::Vertex* vertex)
{
  std::vector<const RrtTree::Vertex*> branch;
  for (; vertex; vertex = vertex->parent)
    branch.push_back(vertex);
  std::reverse(branch.begin(), branch.end());
  return branch;
}

RrtSearch::Path pathOf(const ob::SpaceInformationPtr& information, const BidirectionalTree::Meeting& meeting)
{
  auto path = std::make_shared<PathGeometric>(information);
  for (const RrtTree::Vertex* vertex : branchTo(meeting.start))
    path->append(vertex->state);
  for (const RrtTree::Vertex* vertex = meeting.goal; vertex; vertex = vertex->parent)
    path->append(vertex->state);
  return path;
}
}  // namespace

RrtSearch::RrtSearch(const ob::Planner& planner, Turn& proofs)
  : information_(planner.getSpaceInformation()), proofs_(proofs), trees_(planner)
{
}

void RrtSearch::addCandidate(const ob::GoalSampleableRegion& goal, const BidirectionalTree::Meeting& meeting)
{
  const ob::State* end = meeting.goal ? meeting.goal->root().state : meeting.start->state;
  if (goal.isStartGoalPairValid(meeting.start->root().state, end))
    candidates_.push_back({meeting, pathOf(information_, meeting)});
}

/// Finds the new vertices of the start tree that are in the goal region. The region can be larger than the states of
/// the goal tree.
void RrtSearch::lookAtNewVertices(const ob::GoalSampleableRegion& goal)
{
  const auto& vertices = trees_.tree(BidirectionalTree::Start).vertices();
  while (distances_.size() < vertices.size())
  {
    const Vertex& vertex = *vertices[distances_.size()];
    distances_.push_back(0.0);
    if (goal.isSatisfied(vertex.state, &distances_.back()))
      addCandidate(goal, {&vertex, nullptr});
  }
}

/// The vertex of the start tree that is closest to the goal; null if there is none.
const RrtTree::Vertex* RrtSearch::closest() const
{
  const auto& vertices = trees_.tree(BidirectionalTree::Start).vertices();
  const Vertex* closest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < distances_.size(); ++i)
    if (!vertices[i]->removed && distances_[i] < least)
    {
      closest = vertices[i].get();
      least = distances_[i];
    }
  return closest;
}

double RrtSearch::distanceToGoal() const
{
  const Vertex* const vertex = closest();
  return vertex ? distances_[vertex->number] : std::numeric_limits<double>::infinity();
}

/// True if all motions of the path through a meeting are valid by the validator's own rule. Invalid motions are removed
/// from the trees.
bool RrtSearch::isProven(const MotionValidator& validator, const BidirectionalTree::Meeting& meeting,
                         const ob::PlannerTerminationCondition& ptc)
{
  while (!proofs_.takeFor(kLookAtEnd))
    if (ptc)
      return false;
  const Finally give_turn([this] { proofs_.give(); });
  if (ptc)
    return false;
  std::vector<MotionValidator::Motion> motions;
  std::vector<std::pair<BidirectionalTree::Side, const Vertex*>> ends;  // the later vertex of each motion within a tree
  const auto add = [&](BidirectionalTree::Side side, const Vertex* vertex)
  {
    for (; vertex && vertex->parent; vertex = vertex->parent)
    {
      if (vertex->proven)  // in an earlier candidate, another motion was invalid
        continue;
      const Vertex* const parent = vertex->parent;
      motions.emplace_back(side == BidirectionalTree::Start ? parent->state : vertex->state,
                           side == BidirectionalTree::Start ? vertex->state : parent->state);
      ends.emplace_back(side, vertex);
    }
  };
  add(BidirectionalTree::Start, meeting.start);
  add(BidirectionalTree::Goal, meeting.goal);
  if (meeting.goal)
    motions.emplace_back(meeting.start->state, meeting.goal->state);
  const std::vector<std::uint8_t> valid = validator.validateMotions(motions, ptc);
  if (ptc)  // motions without a verdict are reported as invalid
    return std::find(valid.begin(), valid.end(), 0) == valid.end();
  std::array<std::vector<const Vertex*>, 2> invalid;  // by tree
  for (std::size_t i = 0; i < ends.size(); ++i)
  {
    const auto& [side, vertex] = ends[i];
    if (valid[i] != 0)
      trees_.setProven(side, *vertex);
    else
      invalid[side].push_back(vertex);
  }
  for (const BidirectionalTree::Side side : {BidirectionalTree::Start, BidirectionalTree::Goal})
    trees_.remove(side, invalid[side]);
  return std::find(valid.begin(), valid.end(), 0) == valid.end();
}

RrtSearch::Path RrtSearch::provenPath(const MotionValidator& validator, const ob::PlannerTerminationCondition& ptc)
{
  std::stable_sort(candidates_.begin(), candidates_.end(),
                   [](const Candidate& a, const Candidate& b) { return a.path->length() < b.path->length(); });
  std::size_t done = 0;
  Path found;
  for (; !found && done < candidates_.size() && !ptc; ++done)
  {
    const auto& [meeting, path] = candidates_[done];
    if (meeting.start->removed || (meeting.goal && meeting.goal->removed))
      continue;
    if (isProven(validator, meeting, ptc))
    {
      meeting_ = meeting;
      found = path;
    }
    else if (ptc)
      break;
  }
  candidates_.erase(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(done));
  return found;
}

/// Takes the new meetings and vertices of the trees. Returns a solution, or null.
RrtSearch::Path RrtSearch::take(const std::vector<BidirectionalTree::Meeting>& meetings,
                                const MotionValidator& validator, const ob::GoalSampleableRegion& goal,
                                const ob::PlannerTerminationCondition& ptc)
{
  for (const BidirectionalTree::Meeting& meeting : meetings)
    addCandidate(goal, meeting);
  lookAtNewVertices(goal);
  return provenPath(validator, ptc);
}

/// Waits until the proof of another search, if any, has ended. Returns false if this search is to end.
bool RrtSearch::waitForProof(const ob::PlannerTerminationCondition& ptc)
{
  const std::uint64_t before = proofs_.given();
  while (!proofs_.waitFor(before, kLookAtEnd))
    if (ptc)
      return false;
  return !ptc;
}

RrtSearch::Path RrtSearch::runRound(const MotionValidator& validator, const ob::GoalSampleableRegion& goal,
                                    const BidirectionalTree::Limits& limits, const ob::PlannerTerminationCondition& ptc)
{
  return waitForProof(ptc) ? take(trees_.grow(validator, limits, ptc), validator, goal, ptc) : nullptr;
}

RrtSearch::Path RrtSearch::followPaths(const MotionValidator& validator, const ob::GoalSampleableRegion& goal,
                                       const std::vector<PathGeometric>& known, double range,
                                       const ob::PlannerTerminationCondition& ptc)
{
  const std::vector<PathGeometric> routes = knownRoutes(information_, known, trees_.roots(BidirectionalTree::Start),
                                                        trees_.roots(BidirectionalTree::Goal), range);
  return routes.empty() || !waitForProof(ptc) ? nullptr
                                              : take(trees_.follow(validator, routes, ptc), validator, goal, ptc);
}

RrtSearch::Path RrtSearch::approximatePath(const MotionValidator& validator,
                                           const ob::PlannerTerminationCondition& ptc) const
{
  const std::vector<const Vertex*> branch = branchTo(closest());
  std::vector<MotionValidator::Motion> motions;
  for (std::size_t i = 1; i < branch.size(); ++i)
    motions.emplace_back(branch[i - 1]->state, branch[i]->state);
  const std::vector<std::uint8_t> valid = validator.validateMotions(motions, ptc);
  const auto proven = static_cast<std::size_t>(std::find(valid.begin(), valid.end(), 0) - valid.begin());
  return proven == 0 ? nullptr : pathOf(information_, {branch[proven], nullptr});
}

void RrtSearch::addTo(ob::PlannerData& data) const
{
  for (const auto& vertex : trees_.tree(BidirectionalTree::Start).vertices())
  {
    if (vertex->removed)
      continue;
    if (vertex->parent)
      data.addEdge(ob::PlannerDataVertex(vertex->parent->state, 1), ob::PlannerDataVertex(vertex->state, 1));
    else
      data.addStartVertex(ob::PlannerDataVertex(vertex->state, 1));
  }
  for (const auto& vertex : trees_.tree(BidirectionalTree::Goal).vertices())
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
}  // namespace gpu_planning_scene::core
