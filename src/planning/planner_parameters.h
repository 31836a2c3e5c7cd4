#pragma once

#include <map>
#include <string>

#include <ompl/base/Planner.h>

namespace gpu_planning_scene::core
{
/// Sets parameters by OMPL's names. Throws Error for one that the planner does not have, or that cannot have the value.
void setParameters(ompl::base::Planner& planner, const std::map<std::string, std::string>& parameters);
}  // namespace gpu_planning_scene::core
