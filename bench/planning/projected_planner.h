#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/kinematic_constraints.h"
#include "gpu_planning_scene/planning_scene.h"
#include "gpu_planning_scene/state_checker.h"

namespace gpu_planning_scene::core::benchmark
{
/// The outcome of OMPL's constrained planner.
struct ProjectedPath
{
  bool is_solved = false;
  double seconds = 0.0;
  std::vector<std::vector<double>> rows;  ///< of all variables, interpolated as OMPL does it
};

/// Plans with OMPL's RRTConnect in OMPL's ProjectedStateSpace, with states checked by `checker`. The constraint is an
/// equality: the excess of each number over its tolerance is 0, as in MoveIt's constrained planning. `group`: one of
/// revolute joints with limits. Z. Kingston, M. Moll, L. E. Kavraki: Exploring implicit spaces for constrained
/// sampling-based planning. IJRR 38(10-11), 2019.
ProjectedPath planProjected(const std::shared_ptr<const PlanningScene>& scene,
                            const std::shared_ptr<StateChecker>& checker, const std::string& group,
                            const KinematicConstraints& constraints, const std::vector<double>& start,
                            const std::vector<std::vector<double>>& goals, double seconds);
}  // namespace gpu_planning_scene::core::benchmark
