#include "planning/two_trees.h"

#include <algorithm>
#include <cmath>

// A round collects the next motions of all attempts and of the random branches. It checks their samples in one call and
// adds the valid motions to the trees.
// J. J. Kuffner, S. M. LaValle: RRT-Connect: An efficient approach to single-query path planning. ICRA 2000.

namespace gpu_planning_scene::core
{
namespace
{
// Keeps a round short for every range.
constexpr std::size_t kMostPieces = 64;

// Between two roots, a free straight line saves the most work. There are few of these lines, so each gets many segments
// at once.
constexpr std::size_t kPiecesBetweenRoots = 32;

TwoTrees::Side otherThan(TwoTrees::Side side)
{
  return side == TwoTrees::Start ? TwoTrees::Goal : TwoTrees::Start;
}
}  // namespace

TwoTrees::TwoTrees(const ompl::base::Planner& planner)
  : information_(planner.getSpaceInformation()),
    sampler_(information_->allocStateSampler()),
    trees_{RrtTree(planner), RrtTree(planner)}
{
}

TwoTrees::~TwoTrees()
{
  for (ompl::base::State* state : scratch_)
    information_->freeState(state);
}

void TwoTrees::addRoot(Side side, const ompl::base::State* state)
{
  const Vertex& root = trees_[side].add(state, nullptr);
  if (trees_[otherThan(side)].size() != 0)
    ways_.push_back({otherThan(side), nullptr, &root, kPiecesBetweenRoots});
}

void TwoTrees::remove(Side side, const std::vector<const Vertex*>& vertices)
{
  trees_[side].remove(vertices);
  ways_.erase(std::remove_if(ways_.begin(), ways_.end(),
                             [](const Way& way) { return way.to->removed || (way.from && way.from->removed); }),
              ways_.end());
}

ompl::base::State* TwoTrees::scratch()
{
  if (scratch_used_ == scratch_.size())
    scratch_.push_back(information_->allocState());
  return scratch_[scratch_used_++];
}

/// The next motions towards the target of a way.
TwoTrees::Attempt TwoTrees::pieces(Way way, double range)
{
  if (!way.from)
    way.from = &trees_[way.side].nearest(way.to->state);
  const double distance = information_->distance(way.from->state, way.to->state);
  const double count = std::max(1.0, std::ceil(distance / range));
  Attempt attempt{way, {}};
  while (attempt.states.size() < way.most_pieces)
  {
    const double piece = static_cast<double>(attempt.states.size()) + 1.0;
    if (piece >= count)
    {
      attempt.states.push_back(way.to->state);
      break;
    }
    ompl::base::State* state = scratch();
    information_->getStateSpace()->interpolate(way.from->state, way.to->state, piece / count, state);
    attempt.states.push_back(state);
  }
  return attempt;
}

TwoTrees::Attempt TwoTrees::randomBranch(Side side, double range)
{
  ompl::base::State* state = scratch();
  sampler_->sampleUniform(state);
  const Vertex& from = trees_[side].nearest(state);
  const double distance = information_->distance(from.state, state);
  if (distance > range)
    information_->getStateSpace()->interpolate(from.state, state, range / distance, state);
  return {{side, &from, nullptr, 1}, {state}};
}

/// Adds the valid first motions of an attempt to the tree. Returns the last vertex; `done` gets the number of valid
/// motions.
const RrtTree::Vertex& TwoTrees::advance(const Attempt& attempt, const std::uint8_t* valid, std::size_t& done)
{
  const Vertex* tip = attempt.way.from;
  for (done = 0; done < attempt.states.size() && valid[done] != 0; ++done)
    if (!attempt.way.to || attempt.states[done] != attempt.way.to->state)
      tip = &trees_[attempt.way.side].add(attempt.states[done], tip);
  return *tip;
}

std::vector<TwoTrees::Meeting> TwoTrees::grow(const MotionValidator& validator, std::size_t branches, double range,
                                              const ompl::base::PlannerTerminationCondition& ptc)
{
  scratch_used_ = 0;
  std::vector<Attempt> attempts;
  for (const Way& way : ways_)
    attempts.push_back(pieces(way, range));
  for (std::size_t i = 0; i < branches; ++i)
    attempts.push_back(randomBranch(turn_, range));

  // The motions get the direction that they will have in the path.
  std::vector<MotionValidator::Motion> motions;
  for (const Attempt& attempt : attempts)
  {
    const ompl::base::State* last = attempt.way.from->state;
    for (const ompl::base::State* state : attempt.states)
    {
      motions.emplace_back(attempt.way.side == Start ? last : state, attempt.way.side == Start ? state : last);
      last = state;
    }
  }
  const std::vector<std::uint8_t> valid = validator.validateSamples(motions, ptc);
  if (ptc)  // motions without a verdict are reported as invalid
    return {};
  turn_ = otherThan(turn_);
  ways_.clear();

  std::vector<Meeting> meetings;
  const std::uint8_t* first = valid.data();
  for (const Attempt& attempt : attempts)
  {
    const Way& way = attempt.way;
    std::size_t done = 0;
    const Vertex& tip = advance(attempt, first, done);
    first += attempt.states.size();
    if (!way.to && done != 0)
      ways_.push_back({otherThan(way.side), nullptr, &tip, 1});
    if (!way.to || done < attempt.states.size())
      continue;
    if (attempt.states.back() == way.to->state)
      meetings.push_back(way.side == Start ? Meeting{&tip, way.to} : Meeting{way.to, &tip});
    else
      ways_.push_back({way.side, &tip, way.to, std::min(kMostPieces, 2 * way.most_pieces)});
  }
  return meetings;
}
}  // namespace gpu_planning_scene::core
