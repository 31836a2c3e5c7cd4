#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <ompl/base/Planner.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/motion_validator.h"
#include "planning/search/half_turn_window.h"
#include "planning/search/rrt_tree.h"

namespace gpu_planning_scene::core
{
/// Two trees that grow towards each other from the start states and from the goal states, many branches at a time.
/// Not thread-safe. The idea of RRT-Connect: J. J. Kuffner, S. M. LaValle, ICRA 2000.
class BidirectionalTree
{
 public:
  enum Side
  {
    Start,
    Goal
  };

  /// A place where the trees meet: the samples of the straight motion between the two vertices are free.
  struct Meeting
  {
    const RrtTree::Vertex* start;
    const RrtTree::Vertex* goal;
  };

  struct Limits
  {
    std::size_t branches;   ///< random branches of a round
    double range;           ///< of a motion, above 0
    double largest_length;  ///< of a path through a random state, from a root to a root of the other tree
  };

  explicit BidirectionalTree(const ompl::base::Planner& planner);
  ~BidirectionalTree();
  BidirectionalTree(const BidirectionalTree&) = delete;
  BidirectionalTree& operator=(const BidirectionalTree&) = delete;

  const RrtTree& tree(Side side) const { return trees_[side]; }
  const std::vector<const ompl::base::State*>& roots(Side side) const { return roots_[side]; }

  /// Removes vertices, because the motions from their parents to them are not valid after all: see RrtTree::remove.
  void remove(Side side, const std::vector<const RrtTree::Vertex*>& vertices);

  /// The motion from the parent of this vertex is valid by the validator's own rule.
  void setProven(Side side, const RrtTree::Vertex& vertex) { trees_[side].setProven(vertex); }

  /// Adds a root. In the next round, the other tree grows towards it on a straight line.
  void addRoot(Side side, const ompl::base::State* state);

  /// Grows the trees by one round; the samples of all its motions are checked in one call. One tree, mostly the smaller
  /// one, grows motions towards random states: at most `limits.branches`, and none in the first round. Both trees also
  /// grow towards their targets, which are vertices of the other tree. Each vertex of a new random branch becomes a
  /// target of the other tree, from the next round on. Returns the meetings of the trees. If `ptc` ends the round, the
  /// trees stay as they were, and there are no meetings.
  std::vector<Meeting> grow(const MotionValidator& validator, const Limits& limits,
                            const ompl::base::PlannerTerminationCondition& ptc);

  /// Checks the samples of routes in one call. Each leads from a root of the start tree to one of the goal tree. Its
  /// free motions from either end on become branches. If they are not all free, the trees grow towards each other from
  /// the ends of these branches in the next round. Returns the meetings, one for each free route. If `ptc` ends the
  /// call, the trees stay as they were.
  std::vector<Meeting> follow(const MotionValidator& validator,
                              const std::vector<ompl::geometric::PathGeometric>& routes,
                              const ompl::base::PlannerTerminationCondition& ptc);

 private:
  using Vertex = RrtTree::Vertex;

  /// A straight line from a tree to a vertex of the other tree.
  struct Connection
  {
    Side side;
    const Vertex* from;  // null: the vertex of the tree that is nearest to `to` when growth begins
    const Vertex* to;
    std::size_t max_pieces;  // segments to check at once; the number doubles each time
  };

  /// Consecutive motions to check.
  struct Attempt
  {
    Connection connection;  // its `to` is null for a random branch
    std::vector<const ompl::base::State*> states;
  };

  Side growingSide();
  std::size_t branchesOfRound(std::size_t max_branches) const;
  void addProjected(const MotionValidator& validator, const ompl::base::State* to, bool reaches, double range,
                    std::size_t max_pieces, Attempt& attempt);
  Attempt pieces(const MotionValidator& validator, Connection connection, double range);
  void sample(double largest_length, const std::optional<PlaceBetweenRoots>& near, ompl::base::State* state);
  Attempt randomBranch(const MotionValidator& validator, Side side, const Limits& limits, std::size_t& draws);
  double lengthThrough(const ompl::base::State* state) const;
  const Vertex& addBranch(Side side, const Vertex& root, const std::vector<const ompl::base::State*>& states);
  const Vertex& advance(const Attempt& attempt, const std::uint8_t* valid, std::size_t& done);
  ompl::base::State* scratch();

  ompl::base::SpaceInformationPtr information_;
  ompl::base::StateSamplerPtr sampler_;
  HalfTurnWindow window_;
  std::array<std::size_t, 2> branches_{};  // random ones of each tree, without those within a largest length
  std::array<RrtTree, 2> trees_;
  std::array<std::vector<const ompl::base::State*>, 2> roots_;
  std::size_t rounds_ = 0;
  std::vector<Connection> connections_;
  std::vector<ompl::base::State*> scratch_;  // states of a round
  std::size_t scratch_used_ = 0;
};
}  // namespace gpu_planning_scene::core
