#include "gpu_planning_scene/planning/path_length_objective.h"

#include <memory>

#include <ompl/base/samplers/informed/RejectionInfSampler.h>

namespace gpu_planning_scene::core
{
PathLengthObjective::PathLengthObjective(const ompl::base::SpaceInformationPtr& information)
  : ompl::base::PathLengthOptimizationObjective(information)
{
}

ompl::base::InformedSamplerPtr PathLengthObjective::allocInformedStateSampler(
    const ompl::base::ProblemDefinitionPtr& definition, unsigned int max_calls) const
{
  return std::make_shared<ompl::base::RejectionInfSampler>(definition, max_calls);
}
}  // namespace gpu_planning_scene::core
