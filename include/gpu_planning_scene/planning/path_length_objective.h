#pragma once

#include <ompl/base/objectives/PathLengthOptimizationObjective.h>

namespace gpu_planning_scene::core
{
/// The length of a path, as an objective for informed planners such as BITstar, which sample only states that can
/// improve the path. OMPL's own objective throws in most state spaces, also in a GroupStateSpace. This objective works
/// in every space: its sampler rejects samples that cannot improve the path.
class PathLengthObjective : public ompl::base::PathLengthOptimizationObjective
{
 public:
  explicit PathLengthObjective(const ompl::base::SpaceInformationPtr& information);

  ompl::base::InformedSamplerPtr allocInformedStateSampler(const ompl::base::ProblemDefinitionPtr& definition,
                                                           unsigned int max_calls) const override;
};
}  // namespace gpu_planning_scene::core
