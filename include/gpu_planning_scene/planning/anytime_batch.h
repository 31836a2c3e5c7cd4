#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include <ompl/base/Planner.h>
#include <ompl/geometric/PathGeometric.h>

#include "gpu_planning_scene/planning/known_paths.h"

namespace gpu_planning_scene::core
{
class BatchRrtConnect;

/// Finds a path with BatchRrtConnect, and then shorter ones until the time is up, with PathOptimizer. It takes all of
/// its time, unless the path is the straight motion to the only goal. It needs a MotionValidator and a goal of states.
/// OMPL's intermediate-solution callback gets each path, and the progress property "best cost REAL" its length; the
/// property may be read while solve() runs. Otherwise not thread-safe.
class AnytimeBatch : public ompl::base::Planner, public TriesKnownPaths
{
 public:
  explicit AnytimeBatch(const ompl::base::SpaceInformationPtr& information);
  ~AnytimeBatch() override;

  /// Forgets the path and the trees of another problem.
  void setProblemDefinition(const ompl::base::ProblemDefinitionPtr& definition) override;
  void setKnownPaths(std::vector<ompl::geometric::PathGeometric> paths) override;
  /// Throws ompl::Exception if the space information has no gpu_planning_scene::core::MotionValidator.
  void setup() override;
  void clear() override;
  /// The path of the problem definition is the shortest one. A second call goes on with it.
  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& ptc) override;
  void getPlannerData(ompl::base::PlannerData& data) const override;

 private:
  void take(const ompl::geometric::PathGeometric& path);

  std::shared_ptr<BatchRrtConnect> search_;
  ompl::base::ProblemDefinitionPtr searched_;  // the problem, with the solutions of the search alone; null: not begun
  std::shared_ptr<ompl::geometric::PathGeometric> best_;
  std::atomic<double> best_length_;
};
}  // namespace gpu_planning_scene::core
