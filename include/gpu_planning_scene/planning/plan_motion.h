#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <ompl/base/Planner.h>

#include "gpu_planning_scene/motion_checker.h"
#include "gpu_planning_scene/planning/planner_factory.h"
#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A motion that is wanted. Rows are of all variables of the robot; what the group does not move stays as it is at the
/// start.
struct PlanningQuery
{
  std::string group;
  std::vector<double> start;
  std::vector<std::vector<double>> goals;  ///< any of them
  /// For planning, with a look at the start and the goals; planners take a little more. Simplification, and then a last
  /// look at the path, each have what is left, and at least a tenth and 0.1 s.
  double seconds = 5.0;
  bool simplify = true;
  MotionCheckerOptions motions;
  std::map<std::string, std::string> parameters = {};  ///< of the planner, by OMPL's names
  std::vector<std::string> projection = {};            ///< joints that planners with projections look at; none: default
};

enum class PlanningStatus
{
  Solved,
  Approximate,  ///< there was no time for more: the path ends as near to a goal as was found
  NoSolution,   ///< nor was anything found that comes nearer, or it is not valid by the motion rule
  StartInCollision,
  GoalsInCollision,  ///< the first of the goals, of which none is both free and within bounds
  OutOfBounds        ///< the start, or the first of the goals, of which none is both free and within bounds
};

struct PlanningResult
{
  PlanningStatus status = PlanningStatus::NoSolution;
  std::string message;                         ///< what is wrong, in one line; empty where it is solved
  std::vector<std::vector<double>> waypoints;  ///< rows of all variables; none unless solved or approximate
  double planning_seconds = 0.0;               ///< with the look at the start and the goals, and the proof of the path
  double simplification_seconds = 0.0;
  double checking_seconds = 0.0;  ///< of both
  std::uint64_t states_checked = 0;
  std::uint64_t revision = 0;  ///< of the scene
};

/// Plans with the planner that `factory` makes. `checker` has `scene`. `stop`: asked now and then whether to end early;
/// a planner may then take its time to end. Throws Error: an unknown group, parameter or joint of the projection, a row
/// of the wrong length or with a value that is not finite, an angle of the start beyond 1e6 rad, no goal, times that
/// are not above 0 or beyond 1e9 s. Throws what the planner throws. Thread-safe with a checker for each call.
PlanningResult planMotion(const std::shared_ptr<const PlanningScene>& scene,
                          const std::shared_ptr<StateChecker>& checker, const PlanningQuery& query,
                          const PlannerFactory& factory, const std::function<bool()>& stop = {});
}  // namespace gpu_planning_scene::core
