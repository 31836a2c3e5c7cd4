#pragma once

#include <memory>

#include <ompl/base/Planner.h>

namespace gpu_planning_scene::core
{
/// Finds a path with BatchRrtConnect, and then shorter ones until the time is up, with PathOptimizer. It takes all of
/// its time, unless the path is the straight motion to the only goal. It needs a MotionValidator and a goal of states.
/// OMPL's intermediate-solution callback gets each path, and the progress property "best cost REAL" its length. Not
/// thread-safe.
class AnytimeBatch : public ompl::base::Planner
{
 public:
  explicit AnytimeBatch(const ompl::base::SpaceInformationPtr& information);
  ~AnytimeBatch() override;

  /// Throws ompl::Exception if the space information has no gpu_planning_scene::core::MotionValidator.
  void setup() override;
  void clear() override;
  /// The path of the problem definition is the shortest one. A second call goes on with it.
  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& ptc) override;
  void getPlannerData(ompl::base::PlannerData& data) const override;

 private:
  ompl::base::PlannerPtr search_;
  ompl::base::PathPtr best_;
};
}  // namespace gpu_planning_scene::core
