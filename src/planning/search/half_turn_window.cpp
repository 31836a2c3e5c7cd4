#include "planning/search/half_turn_window.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/math_constants.h"
#include "gpu_planning_scene/planning/group_state_space.h"

namespace gpu_planning_scene::core
{
namespace
{
constexpr std::size_t kBranchesPerWholeSpace = 4;

// The fractional parts of its multiples fill the interval from 0 to 1 evenly.
constexpr double kGoldenRatio = 1.6180339887498949;
}  // namespace

std::optional<PlaceBetweenRoots> placeOfBranch(std::size_t number, std::size_t starts, std::size_t goals)
{
  constexpr std::size_t kNear = kBranchesPerWholeSpace - 1;
  const std::size_t in_round = number % kBranchesPerWholeSpace;
  if (in_round == kNear)
    return std::nullopt;
  // Each pair of roots has a round of branches in turn.
  const std::size_t round = number / kBranchesPerWholeSpace;
  const std::size_t earlier_rounds = round / (starts * goals);  // of the same pair
  const double multiple = kGoldenRatio * static_cast<double>(earlier_rounds * kNear + in_round);
  return PlaceBetweenRoots{round % starts, round / starts % goals, multiple - std::floor(multiple)};
}

HalfTurnWindow::HalfTurnWindow(ompl::base::StateSpacePtr space) : space_(std::move(space))
{
  const auto& group_space = dynamic_cast<const GroupStateSpace&>(*space_);
  const std::vector<int>& variables = group_space.variables();
  for (const Joint& joint : group_space.robot()->joints())
  {
    const auto found = std::find(variables.begin(), variables.end(), joint.first_variable);
    if (joint.type != JointType::Revolute || joint.mimic || found == variables.end())
      continue;
    const auto value = static_cast<std::size_t>(found - variables.begin());
    const auto [lower, upper] = group_space.ranges()[value];
    if (upper - lower > kPi)
      joints_.push_back({group_space.getValueLocations()[value], lower, upper});
  }
}

void HalfTurnWindow::moveInto(const ompl::base::State* from, const ompl::base::State* to, double t,
                              ompl::base::State* state) const
{
  for (const auto& [location, lower, upper] : joints_)
  {
    const double begin = *space_->getValueAddressAtLocation(from, location);
    const double end = *space_->getValueAddressAtLocation(to, location);
    const double middle = begin + t * (end - begin);
    const double least = std::max(lower, middle - kPi);
    const double most = std::min(upper, middle + kPi);
    double& value = *space_->getValueAddressAtLocation(state, location);
    value = std::clamp(least + (value - lower) / (upper - lower) * (most - least), least, most);
  }
}
}  // namespace gpu_planning_scene::core
