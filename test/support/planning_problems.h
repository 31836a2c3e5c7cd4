#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// A motion to be planned: rows of all variables of the robot.
struct PlanningProblem
{
  std::string name;  ///< SET/NUMBER
  std::string group;
  std::shared_ptr<const PlanningScene> scene;
  std::vector<double> start;
  std::vector<double> goal;
};

/// The folder of the problems, which need not be there.
std::string planningProblemFolder();

/// The names of all problems of the ur5, sorted; none where ../shared is missing.
std::vector<std::string> planningProblemNames();

/// Throws Error for a file that cannot be read. All problems share one robot.
PlanningProblem loadPlanningProblem(const std::string& name);
}  // namespace gpu_planning_scene::core
