#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <ompl/base/ScopedState.h>
#include <ompl/base/goals/GoalSampleableRegion.h>

#include "gpu_planning_scene/inverse_kinematics.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"
#include "model/inverse_kinematics/ik_search.h"

namespace gpu_planning_scene::core
{
/// A goal of states and of regions: the states that fulfil constraints, for example those in which a link has a pose.
/// States of the regions are sampled by inverse kinematics when a planner asks for them, also while it searches, and
/// checked for collision in batches. isSatisfied() is thread-safe; the other functions are for one thread at a time.
class GoalRegions : public ompl::base::GoalSampleableRegion
{
 public:
  /// `start`: where the searches begin, one value per variable of the robot; variables outside the group keep its
  /// values. `states`: further goals, known to be free. `checker`: of `scene`. `seed`: of the random numbers. Throws
  /// the errors of InverseKinematics; those of a region name it if there are several.
  GoalRegions(const ompl::base::SpaceInformationPtr& information, std::shared_ptr<const PlanningScene> scene,
              std::shared_ptr<StateChecker> checker, const std::vector<KinematicConstraints>& regions,
              const std::vector<double>& start, const std::vector<ompl::base::ScopedState<>>& states,
              std::uint64_t seed);
  ~GoalRegions() override;

  /// Samples until there are some states, or no more are found, or `stop` returns true. Returns whether there are any.
  bool prepare(const std::function<bool()>& stop);

  /// Why there are no states: the faults of the regions in one line. `name`: of the only region, "goal". `in_collision`
  /// gets whether states were found that collide.
  std::string fault(const std::string& name, bool& in_collision) const;

  /// Number of states sampled so far.
  std::size_t sampled() const { return states_.size(); }

  // OMPL's interface.
  void sampleGoal(ompl::base::State* state) const override;
  /// The number of states. Samples more first, for a short time, if all states have been handed out.
  unsigned int maxSampleCount() const override;
  double distanceGoal(const ompl::base::State* state) const override;

 private:
  struct Region;

  void sample(const std::function<bool()>& stop) const;
  void judge(Region& region, const std::vector<std::vector<double>>& candidates) const;

  std::shared_ptr<const PlanningScene> scene_;
  std::shared_ptr<StateChecker> checker_;
  std::shared_ptr<const GroupStateSpace> space_;
  const std::vector<double> start_;
  std::vector<std::unique_ptr<Region>> regions_;
  std::vector<ompl::base::ScopedState<>> fixed_;
  // OMPL's functions for sampling are const.
  mutable std::vector<ompl::base::State*> states_;
  mutable std::size_t next_ = 0;
  mutable std::size_t idle_ = 0;  // turns of sampling in a row without a new state
};
}  // namespace gpu_planning_scene::core
