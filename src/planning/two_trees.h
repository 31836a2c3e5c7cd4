#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <ompl/base/Planner.h>

#include "gpu_planning_scene/planning/motion_validator.h"
#include "planning/rrt_tree.h"

namespace gpu_planning_scene::core
{
/// A tree from the start states and one from the goal states that grow towards each other, many branches at a time.
class TwoTrees
{
 public:
  enum Side
  {
    Start,
    Goal
  };

  /// Where the trees meet: the samples of the straight motion between the two vertices are free.
  struct Meeting
  {
    const RrtTree::Vertex* start;
    const RrtTree::Vertex* goal;
  };

  explicit TwoTrees(const ompl::base::Planner& planner);
  ~TwoTrees();
  TwoTrees(const TwoTrees&) = delete;
  TwoTrees& operator=(const TwoTrees&) = delete;

  const RrtTree& tree(Side side) const { return trees_[side]; }

  /// Where the straight motions from vertices' parents to them are not valid after all: see RrtTree::remove.
  void remove(Side side, const std::vector<const RrtTree::Vertex*>& vertices);

  /// The other tree tries the straight way to it in the next round.
  void addRoot(Side side, const ompl::base::State* state);

  /// A round, whose motions' samples are checked in one call. The tree whose turn it is grows `branches` motions
  /// towards random states. Both go on with the straight ways that they are on; each vertex of a new branch becomes the
  /// end of such a way of the other tree, from the next round on. `range`: the longest motion, above 0. Returns where
  /// they meet. Where `ptc` ends the round, nothing comes of it.
  std::vector<Meeting> grow(const MotionValidator& validator, std::size_t branches, double range,
                            const ompl::base::PlannerTerminationCondition& ptc);

 private:
  using Vertex = RrtTree::Vertex;

  /// A straight way of a tree to a vertex of the other.
  struct Way
  {
    Side side;
    const Vertex* from;  // null: the tree's nearest vertex, when it sets out
    const Vertex* to;
    std::size_t most_pieces;  // to check at once; twice as many each time
  };

  /// Motions that follow one another, to be checked.
  struct Attempt
  {
    Way way;  // to nowhere where it is a random branch
    std::vector<const ompl::base::State*> states;
  };

  Attempt pieces(Way way, double range);
  Attempt randomBranch(Side side, double range);
  const Vertex& advance(const Attempt& attempt, const std::uint8_t* valid, std::size_t& done);
  ompl::base::State* scratch();

  ompl::base::SpaceInformationPtr information_;
  ompl::base::StateSamplerPtr sampler_;
  std::array<RrtTree, 2> trees_;
  Side turn_ = Start;
  std::vector<Way> ways_;
  std::vector<ompl::base::State*> scratch_;  // of a round
  std::size_t scratch_used_ = 0;
};
}  // namespace gpu_planning_scene::core
