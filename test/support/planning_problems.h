#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A motion planning problem. Its states are rows of all variables of the robot.
struct PlanningProblem
{
  std::string name;  ///< SET/NUMBER
  std::string group;
  std::shared_ptr<const PlanningScene> scene;
  std::vector<double> start;
  std::vector<double> goal;
};

/// The folder of the problems. It may be missing.
std::string planningProblemFolder();

/// The sorted names of all problems of the ur5; empty if ../shared is missing.
std::vector<std::string> planningProblemNames();

/// At most `max` of the names, evenly spread, so that each set has some of them. Throws Error if there are no problems.
std::vector<std::string> chosenPlanningProblems(std::size_t max);

/// Throws Error if a file cannot be read. All problems share one robot.
PlanningProblem loadPlanningProblem(const std::string& name);
}  // namespace gpu_planning_scene::core
