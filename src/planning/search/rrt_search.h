#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <ompl/base/Planner.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/geometric/PathGeometric.h>

#include "base/turn.h"
#include "gpu_planning_scene/planning/motion_validator.h"
#include "planning/search/bidirectional_tree.h"

namespace gpu_planning_scene::core
{
/// The search of BatchRrtConnect. Two trees grow by motions that are checked coarsely. If they meet, there is a path
/// through the meeting; its motions are proven by the validator's own rule. While one search proves a path, the
/// searches that share its turn pause before their next round, so that the cores are free for the proof. Most proofs
/// succeed and end the plan. Not thread-safe.
class RrtSearch
{
 public:
  using Path = std::shared_ptr<ompl::geometric::PathGeometric>;

  /// `proofs`: the turn of the searches that run side by side. It must outlive this object.
  RrtSearch(const ompl::base::Planner& planner, Turn& proofs);

  BidirectionalTree& trees() { return trees_; }

  /// Grows the trees by one round. Returns a solution, or null.
  Path runRound(const MotionValidator& validator, const ompl::base::GoalSampleableRegion& goal,
                const BidirectionalTree::Limits& limits, const ompl::base::PlannerTerminationCondition& ptc);

  /// Tries known paths: see knownRoutes(). Returns a solution, or null.
  Path followPaths(const MotionValidator& validator, const ompl::base::GoalSampleableRegion& goal,
                   const std::vector<ompl::geometric::PathGeometric>& known, double range,
                   const ompl::base::PlannerTerminationCondition& ptc);

  /// Proves the paths through the meetings found so far, shortest first. Returns the first path that is proven before
  /// `ptc` returns true, or null. Invalid motions are removed from the trees. Motions without a verdict stay.
  Path provenPath(const MotionValidator& validator, const ompl::base::PlannerTerminationCondition& ptc);

  /// The path to the vertex that is closest to the goal, up to its first motion that is not proven before `ptc` returns
  /// true; null if no motion is proven.
  Path approximatePath(const MotionValidator& validator, const ompl::base::PlannerTerminationCondition& ptc) const;

  /// The distance to the goal from the vertex that is closest to it; infinite if there is none.
  double distanceToGoal() const;

  void addTo(ompl::base::PlannerData& data) const;

 private:
  using Vertex = RrtTree::Vertex;

  /// A meeting that is not checked yet, and the path through it.
  struct Candidate
  {
    BidirectionalTree::Meeting meeting;
    Path path;
  };

  Path take(const std::vector<BidirectionalTree::Meeting>& meetings, const MotionValidator& validator,
            const ompl::base::GoalSampleableRegion& goal, const ompl::base::PlannerTerminationCondition& ptc);
  void addCandidate(const ompl::base::GoalSampleableRegion& goal, const BidirectionalTree::Meeting& meeting);
  void lookAtNewVertices(const ompl::base::GoalSampleableRegion& goal);
  bool waitForProof(const ompl::base::PlannerTerminationCondition& ptc);
  bool isProven(const MotionValidator& validator, const BidirectionalTree::Meeting& meeting,
                const ompl::base::PlannerTerminationCondition& ptc);
  const Vertex* closest() const;

  ompl::base::SpaceInformationPtr information_;
  Turn& proofs_;
  BidirectionalTree trees_;
  std::vector<Candidate> candidates_;
  /// Meeting of the last solution. Its goal vertex is null if its start vertex is in the goal region.
  BidirectionalTree::Meeting meeting_{nullptr, nullptr};
  std::vector<double> distances_;  // from the vertices of the start tree to the goal
};
}  // namespace gpu_planning_scene::core
