#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <ompl/base/Planner.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/motion_validator.h"
#include "planning/two_trees.h"

namespace gpu_planning_scene::core
{
/// The search of BatchRrtConnect: two trees that grow by motions whose samples are free, and the paths through where
/// they meet, whose motions are proven by the validator's own rule. Not thread-safe.
class RrtSearch
{
 public:
  using Path = std::shared_ptr<ompl::geometric::PathGeometric>;

  explicit RrtSearch(const ompl::base::Planner& planner);

  TwoTrees& trees() { return trees_; }

  /// A round of the trees. Returns a solution, if there is one.
  Path runRound(const MotionValidator& validator, const ompl::base::GoalSampleableRegion& goal,
                std::size_t most_branches, double range, const ompl::base::PlannerTerminationCondition& ptc);

  /// The first path through where the trees have met so far, shortest first, that is proven before `ptc`; null if there
  /// is none. The motions that are found invalid are taken out of the trees; what there was no time for is kept.
  Path provenPath(const MotionValidator& validator, const ompl::base::PlannerTerminationCondition& ptc);

  /// The way to the vertex that is closest to the goal, as far as it is proven before `ptc`; null if that is nothing.
  Path approximatePath(const MotionValidator& validator, const ompl::base::PlannerTerminationCondition& ptc) const;

  void addTo(ompl::base::PlannerData& data) const;

 private:
  using Vertex = RrtTree::Vertex;

  /// A meeting that is not looked at yet, and the path through it.
  struct Candidate
  {
    TwoTrees::Meeting meeting;
    Path path;
  };

  void addCandidate(const ompl::base::GoalSampleableRegion& goal, const TwoTrees::Meeting& meeting);
  void lookAtNewVertices(const ompl::base::GoalSampleableRegion& goal);
  bool isProven(const MotionValidator& validator, const TwoTrees::Meeting& meeting,
                const ompl::base::PlannerTerminationCondition& ptc);
  const Vertex* closest() const;

  ompl::base::SpaceInformationPtr information_;
  TwoTrees trees_;
  bool is_first_round_ = true;
  std::vector<Candidate> candidates_;
  /// Of the last solution. Its goal vertex is null where its start vertex is in the goal region.
  TwoTrees::Meeting meeting_{nullptr, nullptr};
  std::vector<double> distances_;  // to the goal, of the start tree's vertices
};
}  // namespace gpu_planning_scene::core
