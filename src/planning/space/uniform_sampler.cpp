#include "planning/space/uniform_sampler.h"

#include <algorithm>

// SplitMix64: G. L. Steele, D. Lea, C. H. Flood: Fast splittable pseudorandom number generators. OOPSLA 2014. The bits
// are mixed by D. Stafford's variant 13, as in Java's SplittableRandom.
namespace gpu_planning_scene::core
{
namespace
{
namespace ob = ompl::base;

constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15U;
constexpr std::uint64_t kFirstFactor = 0xbf58476d1ce4e5b9U;
constexpr std::uint64_t kSecondFactor = 0x94d049bb133111ebU;
}  // namespace

UniformSampler::UniformSampler(const ob::StateSpace* space)
  : ob::RealVectorStateSampler(space), counter_(rng_.getLocalSeed())
{
}

/// The next number, from 0 (included) to 1 (excluded).
double UniformSampler::next()
{
  counter_ += kGoldenGamma;
  std::uint64_t bits = counter_;
  bits = (bits ^ (bits >> 30U)) * kFirstFactor;
  bits = (bits ^ (bits >> 27U)) * kSecondFactor;
  bits ^= bits >> 31U;
  return static_cast<double>(bits >> 11U) * 0x1p-53;
}

void UniformSampler::sampleUniform(ob::State* state)
{
  const ob::RealVectorBounds& bounds = space_->as<ob::RealVectorStateSpace>()->getBounds();
  double* const values = state->as<ob::RealVectorStateSpace::StateType>()->values;
  for (std::size_t i = 0; i < bounds.low.size(); ++i)
    values[i] = std::min(bounds.high[i], bounds.low[i] + next() * (bounds.high[i] - bounds.low[i]));
}
}  // namespace gpu_planning_scene::core
