#pragma once

#include <ompl/base/objectives/PathLengthOptimizationObjective.h>

namespace gpu_planning_scene::core
{
/// The length of a path, for planners such as BITstar that sample where a better one may be: OMPL's own objective does
/// so in a few state spaces only and throws in all others, a GroupStateSpace among them. Here samples that cannot be
/// better are rejected, in any space.
class PathLengthObjective : public ompl::base::PathLengthOptimizationObjective
{
 public:
  explicit PathLengthObjective(const ompl::base::SpaceInformationPtr& information);

  ompl::base::InformedSamplerPtr allocInformedStateSampler(const ompl::base::ProblemDefinitionPtr& definition,
                                                           unsigned int most_calls) const override;
};
}  // namespace gpu_planning_scene::core
