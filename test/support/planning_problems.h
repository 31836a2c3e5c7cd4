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

/// Throws Error if a file cannot be read. All problems share one robot.
PlanningProblem loadPlanningProblem(const std::string& name);
}  // namespace gpu_planning_scene::core
