#include "planning/planner_parameters.h"

#include <exception>
#include <vector>

#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::core
{
void setParameters(ompl::base::Planner& planner, const std::map<std::string, std::string>& parameters)
{
  for (const auto& [name, value] : parameters)
  {
    if (!planner.params().hasParam(name))
    {
      std::vector<std::string> names;
      planner.params().getParamNames(names);
      std::string all;
      for (const std::string& known : names)
        all += (all.empty() ? "" : ", ") + known;
      throw Error("planner " + planner.getName() + " has no parameter '" + name + "'; it has " +
                  (all.empty() ? "none" : all));
    }
    bool taken = false;
    try
    {
      taken = planner.params().setParam(name, value);
    }
    catch (const std::exception&)  // OMPL throws if the value is not a number
    {
    }
    if (!taken)
      throw Error("parameter " + name + " of planner " + planner.getName() + " cannot be '" + value + "'");
  }
}
}  // namespace gpu_planning_scene::core
