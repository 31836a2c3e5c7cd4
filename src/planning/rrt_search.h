#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include <ompl/base/Planner.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/motion_validator.h"
#include "planning/two_trees.h"

namespace gpu_planning_scene
{
/// The search of BatchRrtConnect: two trees that grow by motions whose samples are free, and the paths through where
/// they meet, whose motions are proven by the validator's own rule. Not thread-safe.
class RrtSearch
{
 public:
  using Path = std::shared_ptr<ompl::geometric::PathGeometric>;

  explicit RrtSearch(const ompl::base::Planner& planner);

  TwoTrees& trees() { return trees_; }

  /// A round of the trees. Returns a solution, if there is one. A round that `ptc` ends changes nothing.
  Path runRound(const MotionValidator& validator, const ompl::base::GoalSampleableRegion& goal,
                std::size_t most_branches, double range, const ompl::base::PlannerTerminationCondition& ptc);

  /// The way to the vertex that is closest to the goal, as far as it is proven before `ptc`; null if that is nothing.
  Path approximatePath(const MotionValidator& validator, const ompl::base::PlannerTerminationCondition& ptc) const;

  void addTo(ompl::base::PlannerData& data) const;

 private:
  using Vertex = RrtTree::Vertex;

  void lookAtNewVertices(const ompl::base::GoalSampleableRegion& goal, std::vector<TwoTrees::Meeting>& meetings);
  bool isProven(const MotionValidator& validator, const TwoTrees::Meeting& meeting,
                const ompl::base::PlannerTerminationCondition& ptc);

  ompl::base::SpaceInformationPtr information_;
  TwoTrees trees_;
  bool is_first_round_ = true;
  /// Of the last solution. Its goal vertex is null where its start vertex is in the goal region.
  TwoTrees::Meeting meeting_{nullptr, nullptr};
  std::size_t looked_at_ = 0;        // vertices of the start tree whose distance to the goal is known
  const Vertex* closest_ = nullptr;  // of those
  double distance_ = std::numeric_limits<double>::infinity();
};
}  // namespace gpu_planning_scene
