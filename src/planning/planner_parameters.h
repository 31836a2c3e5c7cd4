#pragma once

#include <map>
#include <string>

#include <ompl/base/Planner.h>

namespace gpu_planning_scene::core
{
/// Sets parameters by OMPL's names. Throws Error if the planner does not have the parameter or refuses its value.
void setParameters(ompl::base::Planner& planner, const std::map<std::string, std::string>& parameters);
}  // namespace gpu_planning_scene::core
