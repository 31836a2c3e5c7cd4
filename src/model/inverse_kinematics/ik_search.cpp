#include "model/inverse_kinematics/ik_search.h"

#include <algorithm>
#include <cmath>

#include "gpu_planning_scene/error.h"
#include "model/inverse_kinematics/kinematic_chains.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The state with values in the ranges of the constraints. Variables that are no degree of freedom keep these values.
std::vector<double> clampedTo(const KinematicConstraints& constraints, const double* state, std::size_t width)
{
  std::vector<double> clamped(state, state + width);
  constraints.clampJoints(clamped.data());
  return clamped;
}
}  // namespace

IkSearch::IkSearch(const InverseKinematics& kinematics, const double* state, const IkOptions& options)
  : kinematics_(kinematics),
    options_(options),
    freedoms_(narrowed(kinematics.chains().degreesOfFreedom(), kinematics.constraints().joints)),
    descent_(kinematics.constraints(), kinematics.chains(), freedoms_),
    given_(clampedTo(kinematics.constraints(), state, kinematics.chains().robot().variables().size())),
    starts_(freedoms_, given_.data(), given_.size(), options.seed)
{
  if (options.max_solutions == 0 || options.max_attempts == 0)
    throw Error("inverse kinematics needs at least one attempt and one solution");
}

bool IkSearch::isDistinct(const std::vector<double>& state) const
{
  const auto is_near = [&](const std::vector<double>& other)
  {
    return std::all_of(kinematics_.variables().begin(), kinematics_.variables().end(),
                       [&](int variable)
                       {
                         const auto i = static_cast<std::size_t>(variable);
                         return std::abs(state[i] - other[i]) < options_.least_difference;
                       });
  };
  return std::none_of(found_.begin(), found_.end(), is_near);
}

std::optional<std::vector<double>> IkSearch::next(const std::function<bool()>& stop)
{
  while (attempts_ < options_.max_attempts && found_.size() < options_.max_solutions && !(stop && stop()))
  {
    ++attempts_;
    const double share = starts_.nextShare();
    std::vector<double> state = starts_.next();
    const bool is_solution = descent_.run(state.data(), share);
    if (!is_solution && descent_.squaredError() >= least_error_)
      continue;
    turnTowards(freedoms_, given_.data(), state.data());
    if (!is_solution)
    {
      least_error_ = descent_.squaredError();
      nearest_ = std::move(state);
    }
    else if (isDistinct(state))
    {
      found_.push_back(state);
      return state;
    }
  }
  return std::nullopt;
}
}  // namespace gpu_planning_scene::core
