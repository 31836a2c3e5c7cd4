#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "model/inverse_kinematics/degrees_of_freedom.h"

namespace gpu_planning_scene::core
{
/// The start states of the descents, one after the other: the given state, states near it, then random states.
class StartStates
{
 public:
  /// `state`: `width` values, one per variable of the robot. `freedoms` must outlive this object.
  StartStates(const DegreesOfFreedom& freedoms, const double* state, std::size_t width, std::uint64_t seed);

  const std::vector<double>& given() const { return given_; }
  std::vector<double> next();

  /// The part of the tolerances at which the next descent aims: different ones, so that solutions lie all over a
  /// region.
  double nextShare();

 private:
  const DegreesOfFreedom& freedoms_;
  std::vector<double> given_;  // within the limits
  std::mt19937_64 generator_;
  std::uniform_real_distribution<double> part_{0.0, 1.0};
  std::size_t attempts_ = 0;
};
}  // namespace gpu_planning_scene::core
