#pragma once

#include <cstdint>

#include <ompl/base/spaces/RealVectorStateSpace.h>

namespace gpu_planning_scene::core
{
/// Draws uniform states within bounds some ten times as fast as OMPL's own sampler, whose random numbers took a tenth
/// of the time of a search. The seed is that of OMPL's generator for this sampler, so ompl::RNG::setSeed() determines
/// the states. sampleUniformNear() and sampleGaussian() are OMPL's, with OMPL's generator. Not thread-safe.
class UniformSampler : public ompl::base::RealVectorStateSampler
{
 public:
  explicit UniformSampler(const ompl::base::StateSpace* space);

  /// Each value is from its lower bound (included) to its upper bound (which only rounding can reach).
  void sampleUniform(ompl::base::State* state) override;

 private:
  double next();

  std::uint64_t counter_;
};
}  // namespace gpu_planning_scene::core
