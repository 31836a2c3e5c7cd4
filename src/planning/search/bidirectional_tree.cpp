#include "planning/search/bidirectional_tree.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

// A round collects the next motions of all attempts and of the random branches. It checks their samples in one call and
// adds the valid motions to the trees. The trees stay balanced: a tree in open space would soon have most of the
// vertices, and its growth would cost most of the checks, while the other one looks for its way out.
// J. J. Kuffner, S. M. LaValle: RRT-Connect: An efficient approach to single-query path planning. ICRA 2000.
// Balanced trees: S. M. LaValle: Planning Algorithms. 2006, section 5.5.3.
// Vertices at obstacles grow mostly towards near states: A. Yershova, L. Jaillet, T. Simeon, S. M. LaValle:
// Dynamic-domain RRTs: Efficient exploration by controlling the sampling domain. ICRA 2005.
namespace gpu_planning_scene::core
{
namespace
{
// Keeps a round short for every range.
constexpr std::size_t kMaxPieces = 64;

// Every eighth round grows the larger tree: the smaller one may be in a pocket that is easier to find from outside.
constexpr std::size_t kRoundsOfBothTrees = 8;

// Vertices of the smaller tree per random branch of a round. The branches of a round grow independently of each other,
// so in a small tree many of them would grow into the same region.
constexpr std::size_t kVerticesPerBranch = 8;

// Eight states take hardly more time than one, and in a narrow place most branches collide at their ends.
constexpr std::size_t kLeastBranches = 8;

// In a large tree, the search for the nearest vertex takes time, so the clock is read after the vertices nearest to
// this many random states.
constexpr std::size_t kDrawsBetweenStops = 32;

// Between two roots, a free straight line saves the most work. There are few of these lines, so each gets many segments
// at once.
constexpr std::size_t kPiecesBetweenRoots = 32;

// A projection that moves a state by more than this part of the range has left the neighbourhood of its motion.
constexpr double kLongestProjected = 2.0;

// A projected step that comes nearer to the target by less than this part of the range is not added. Such steps would
// fill the tree with states at the ends of the tolerances.
constexpr double kLeastProgress = 0.1;

// Draws of a random state within the largest length. If that is little more than the distance of the roots, few states
// are within it, and the last draw is taken.
constexpr std::size_t kDrawsWithinLength = 128;

// A vertex at an obstacle grows towards random states within so many ranges of it. The paper's radius R.
constexpr double kDomainOfRanges = 5.0;

// Draws of a random state, until its nearest vertex may grow towards it. The last one is taken, however far it is:
// among many vertices, the search for the nearest one takes as long as the check of a motion.
constexpr std::size_t kDrawsWithinDomain = 12;

BidirectionalTree::Side otherThan(BidirectionalTree::Side side)
{
  return side == BidirectionalTree::Start ? BidirectionalTree::Goal : BidirectionalTree::Start;
}
}  // namespace

BidirectionalTree::BidirectionalTree(const ompl::base::Planner& planner)
  : information_(planner.getSpaceInformation()),
    sampler_(information_->allocStateSampler()),
    window_(information_->getStateSpace()),
    trees_{RrtTree(planner), RrtTree(planner)}
{
}

BidirectionalTree::~BidirectionalTree()
{
  for (ompl::base::State* state : scratch_)
    information_->freeState(state);
}

void BidirectionalTree::addRoot(Side side, const ompl::base::State* state)
{
  const Vertex& root = trees_[side].add(state, nullptr);
  roots_[side].push_back(root.state);
  if (trees_[otherThan(side)].size() != 0)
    connections_.push_back({otherThan(side), nullptr, &root, kPiecesBetweenRoots});
}

void BidirectionalTree::remove(Side side, const std::vector<const Vertex*>& vertices)
{
  trees_[side].remove(vertices);
  connections_.erase(std::remove_if(connections_.begin(), connections_.end(),
                                    [](const Connection& connection) {
                                      return connection.to->removed || (connection.from && connection.from->removed);
                                    }),
                     connections_.end());
}

ompl::base::State* BidirectionalTree::scratch()
{
  if (scratch_used_ == scratch_.size())
    scratch_.push_back(information_->allocState());
  return scratch_[scratch_used_++];
}

/// The next motions towards the target of a connection, under path constraints: each step towards the target is
/// projected onto the constraints, and the motions end where a projection fails or comes no nearer to the target.
/// D. Berenson, S. Srinivasa, D. Ferguson, J. Kuffner: Manipulation planning on constraint manifolds. ICRA 2009
/// (ConstrainedExtend).
void BidirectionalTree::addProjected(const MotionValidator& validator, const ompl::base::State* to, bool reaches,
                                     double range, std::size_t max_pieces, Attempt& attempt)
{
  const ompl::base::State* last = attempt.connection.from->state;
  double distance = information_->distance(last, to);
  while (attempt.states.size() < max_pieces)
  {
    if (reaches && distance <= range)
    {
      attempt.states.push_back(to);
      return;
    }
    ompl::base::State* state = scratch();
    information_->getStateSpace()->interpolate(last, to, std::min(1.0, range / distance), state);
    if (!validator.project(state))
      return;
    const double rest = information_->distance(state, to);
    if (rest > distance - kLeastProgress * range || information_->distance(last, state) > kLongestProjected * range)
      return;
    attempt.states.push_back(state);
    last = state;
    distance = rest;
  }
}

/// The next motions towards the target of a connection.
BidirectionalTree::Attempt BidirectionalTree::pieces(const MotionValidator& validator, Connection connection,
                                                     double range)
{
  if (!connection.from)
    connection.from = &trees_[connection.side].nearest(connection.to->state);
  Attempt attempt{connection, {}};
  if (validator.isConstrained())
  {
    addProjected(validator, connection.to->state, true, range, connection.max_pieces, attempt);
    return attempt;
  }
  const double distance = information_->distance(connection.from->state, connection.to->state);
  const double count = std::max(1.0, std::ceil(distance / range));
  while (attempt.states.size() < connection.max_pieces)
  {
    const double piece = static_cast<double>(attempt.states.size()) + 1.0;
    if (piece >= count)
    {
      attempt.states.push_back(connection.to->state);
      break;
    }
    ompl::base::State* state = scratch();
    information_->getStateSpace()->interpolate(connection.from->state, connection.to->state, piece / count, state);
    attempt.states.push_back(state);
  }
  return attempt;
}

/// The tree whose turn it is to grow random branches.
BidirectionalTree::Side BidirectionalTree::growingSide()
{
  const Side smaller = trees_[Start].size() <= trees_[Goal].size() ? Start : Goal;
  return ++rounds_ % kRoundsOfBothTrees == 0 ? otherThan(smaller) : smaller;
}

std::size_t BidirectionalTree::branchesOfRound(std::size_t max_branches) const
{
  // The first round tries the straight motions between the roots.
  if (rounds_ == 1)
    return 0;
  const std::size_t smaller = std::min(trees_[Start].size(), trees_[Goal].size());
  return std::min(max_branches, std::max(kLeastBranches, smaller / kVerticesPerBranch));
}

/// A lower bound of the length of paths through a state, from a root to a root of the other tree.
double BidirectionalTree::lengthThrough(const ompl::base::State* state) const
{
  double sum = 0.0;
  for (const std::vector<const ompl::base::State*>& roots : roots_)
  {
    double least = std::numeric_limits<double>::infinity();
    for (const ompl::base::State* root : roots)
      least = std::min(least, information_->distance(root, state));
    sum += least;
  }
  return sum;
}

/// Draws a random state: within a largest length, if possible, or near a place, if there is one.
void BidirectionalTree::sample(double largest_length, const std::optional<PlaceBetweenRoots>& near,
                               ompl::base::State* state)
{
  sampler_->sampleUniform(state);
  const bool is_limited = std::isfinite(largest_length);
  for (std::size_t i = 1; is_limited && i < kDrawsWithinLength && lengthThrough(state) >= largest_length; ++i)
    sampler_->sampleUniform(state);
  if (near)
    window_.moveInto(roots_[Start][near->start], roots_[Goal][near->goal], near->t, state);
}

/// A motion from the tree towards a random state. `draws` grows by the number of states whose nearest vertex was
/// searched.
BidirectionalTree::Attempt BidirectionalTree::randomBranch(const MotionValidator& validator, Side side,
                                                           const Limits& limits, std::size_t& draws)
{
  ompl::base::State* state = scratch();
  const Vertex* from = nullptr;
  double distance = 0.0;
  // Within a largest length, the states are near already: more draws made no path shorter.
  const bool is_limited = std::isfinite(limits.largest_length);
  const std::size_t tries = is_limited ? 1 : kDrawsWithinDomain;
  const std::optional<PlaceBetweenRoots> near =
      is_limited ? std::nullopt : placeOfBranch(branches_[side]++, roots_[Start].size(), roots_[Goal].size());
  for (std::size_t i = 0; i < tries; ++i)
  {
    sample(limits.largest_length, near, state);
    from = &trees_[side].nearest(state);
    ++draws;
    distance = information_->distance(from->state, state);
    if (!from->at_obstacle || distance <= kDomainOfRanges * limits.range)
      break;
  }
  Attempt attempt{{side, from, nullptr, 1}, {}};
  if (validator.isConstrained())
  {
    addProjected(validator, state, false, limits.range, 1, attempt);
    return attempt;
  }
  if (distance > limits.range)
    information_->getStateSpace()->interpolate(from->state, state, limits.range / distance, state);
  attempt.states.push_back(state);
  return attempt;
}

/// Adds the valid first motions of an attempt to the tree. Returns the last vertex; `done` gets the number of valid
/// motions.
const RrtTree::Vertex& BidirectionalTree::advance(const Attempt& attempt, const std::uint8_t* valid, std::size_t& done)
{
  const Vertex* tip = attempt.connection.from;
  for (done = 0; done < attempt.states.size() && valid[done] != 0; ++done)
    if (!attempt.connection.to || attempt.states[done] != attempt.connection.to->state)
      tip = &trees_[attempt.connection.side].add(attempt.states[done], tip);
  return *tip;
}

std::vector<BidirectionalTree::Meeting> BidirectionalTree::grow(const MotionValidator& validator, const Limits& limits,
                                                                const ompl::base::PlannerTerminationCondition& ptc)
{
  scratch_used_ = 0;
  const Side side = growingSide();
  std::vector<Attempt> attempts;
  for (const Connection& connection : connections_)
    attempts.push_back(pieces(validator, connection, limits.range));
  const std::size_t branches = branchesOfRound(limits.branches);
  std::size_t draws = 0;  // since the clock was read
  for (std::size_t i = 0; i < branches; ++i)
  {
    if (draws >= kDrawsBetweenStops)
    {
      if (ptc)
        break;
      draws = 0;
    }
    attempts.push_back(randomBranch(validator, side, limits, draws));
  }

  // Each begins at a vertex of a tree or at the end of the motion before it, as validateExtensions requires.
  std::vector<MotionValidator::Motion> motions;
  for (const Attempt& attempt : attempts)
  {
    const ompl::base::State* last = attempt.connection.from->state;
    for (const ompl::base::State* state : attempt.states)
    {
      motions.emplace_back(last, state);
      last = state;
    }
  }
  const std::vector<std::uint8_t> valid = validator.validateExtensions(motions, ptc);
  if (ptc)  // motions without a verdict are reported as invalid
    return {};
  connections_.clear();

  std::vector<Meeting> meetings;
  const std::uint8_t* first = valid.data();
  for (const Attempt& attempt : attempts)
  {
    const Connection& connection = attempt.connection;
    std::size_t done = 0;
    const Vertex& tip = advance(attempt, first, done);
    first += attempt.states.size();
    if (!connection.to && done != 0)
      connections_.push_back({otherThan(connection.side), nullptr, &tip, 1});
    else if (!connection.to && !validator.isConstrained())  // a projection can fail far from obstacles
      trees_[connection.side].setAtObstacle(tip);
    if (!connection.to || attempt.states.empty() || done < attempt.states.size())
      continue;
    if (attempt.states.back() == connection.to->state)
      meetings.push_back(connection.side == Start ? Meeting{&tip, connection.to} : Meeting{connection.to, &tip});
    else
      connections_.push_back({connection.side, &tip, connection.to, std::min(kMaxPieces, 2 * connection.max_pieces)});
  }
  return meetings;
}

/// Adds states one after the other. Returns the vertex of the last one.
const RrtTree::Vertex& BidirectionalTree::addBranch(Side side, const Vertex& root,
                                                    const std::vector<const ompl::base::State*>& states)
{
  const Vertex* tip = &root;
  for (const ompl::base::State* state : states)
    tip = &trees_[side].add(state, tip);
  return *tip;
}

std::vector<BidirectionalTree::Meeting> BidirectionalTree::follow(
    const MotionValidator& validator, const std::vector<ompl::geometric::PathGeometric>& routes,
    const ompl::base::PlannerTerminationCondition& ptc)
{
  std::vector<std::vector<const ompl::base::State*>> states;
  std::vector<MotionValidator::Motion> motions;
  for (const ompl::geometric::PathGeometric& route : routes)
  {
    states.emplace_back();
    for (unsigned int i = 0; i < route.getStateCount(); ++i)
      states.back().push_back(route.getState(i));
    for (std::size_t i = 1; i < states.back().size(); ++i)
      motions.emplace_back(states.back()[i - 1], states.back()[i]);
  }
  const std::vector<std::uint8_t> valid = validator.validateCoarsely(motions, ptc);
  if (ptc)  // motions without a verdict are reported as invalid
    return {};

  std::vector<Meeting> meetings;
  auto first = valid.begin();
  for (const std::vector<const ompl::base::State*>& route : states)
  {
    const auto end = first + static_cast<std::ptrdiff_t>(route.size() - 1);
    const auto at_start = std::find(first, end, 0) - first;  // free motions from the start on
    const auto at_goal =
        std::find(std::reverse_iterator(end), std::reverse_iterator(first), 0) - std::reverse_iterator(end);
    const bool is_free = first + at_start == end;
    first = end;
    // A vertex per state; the roots are in the trees already.
    const Vertex& start = trees_[Start].nearest(route.front());
    const Vertex& goal = trees_[Goal].nearest(route.back());
    const Vertex& tip = addBranch(Start, start, {route.begin() + 1, route.begin() + 1 + at_start - (is_free ? 1 : 0)});
    if (is_free)
    {
      meetings.push_back({&tip, &goal});
      continue;
    }
    const Vertex& goal_tip = addBranch(Goal, goal, {route.rbegin() + 1, route.rbegin() + 1 + at_goal});
    connections_.push_back({Start, &tip, &goal_tip, 1});
  }
  return meetings;
}
}  // namespace gpu_planning_scene::core
