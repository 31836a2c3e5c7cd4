#include "model/inverse_kinematics/start_states.h"

#include "base/math_constants.h"

namespace gpu_planning_scene::core
{
namespace
{
// The first descents begin at the given state and near it, because their solutions are near it too.
constexpr std::size_t kNearbyAttempts = 4;
constexpr double kNearby = 0.1;  // largest distance of such a start from the given state, as a part of the range

// Descents that aim at the whole tolerance could end outside of it by rounding.
constexpr double kLargestShare = 0.9;
}  // namespace

StartStates::StartStates(const DegreesOfFreedom& freedoms, const double* state, std::size_t width, std::uint64_t seed)
  : freedoms_(freedoms), given_(state, state + width), generator_(seed)
{
  clampToLimits(freedoms, given_.data());
}

std::vector<double> StartStates::next()
{
  std::vector<double> start = given_;
  const std::size_t attempt = attempts_++;
  if (attempt == 0)
    return start;
  Eigen::VectorXd step(static_cast<Eigen::Index>(freedoms_.size()));
  const bool is_nearby = attempt <= kNearbyAttempts;
  for (std::size_t i = 0; i < freedoms_.size(); ++i)
  {
    const DegreeOfFreedom& freedom = freedoms_[i];
    const bool is_rotation = freedom.axis >= 0;
    const double lower = is_rotation ? -kPi : freedom.lower;
    const double upper = is_rotation ? kPi : freedom.upper;
    const double value = is_rotation ? 0.0 : start[static_cast<std::size_t>(freedom.variable)];
    step[static_cast<Eigen::Index>(i)] = is_nearby ? kNearby * (upper - lower) * (2.0 * part_(generator_) - 1.0)
                                                   : lower + (upper - lower) * part_(generator_) - value;
  }
  advance(freedoms_, step, start.data());
  return start;
}

double StartStates::nextShare()
{
  return attempts_ == 0 ? kLargestShare : kLargestShare * part_(generator_);
}
}  // namespace gpu_planning_scene::core
