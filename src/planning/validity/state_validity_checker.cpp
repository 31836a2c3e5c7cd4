#include "gpu_planning_scene/planning/state_validity_checker.h"

#include <algorithm>
#include <utility>

#include <ompl/base/SpaceInformation.h>

#include "gpu_planning_scene/error.h"
#include "planning/space/group_space.h"

namespace gpu_planning_scene::core
{
StateValidityChecker::StateValidityChecker(const ompl::base::SpaceInformationPtr& information,
                                           std::shared_ptr<const PlanningScene> scene,
                                           std::shared_ptr<StateChecker> checker)
  : ompl::base::StateValidityChecker(information),
    space_(groupSpaceOf(*information, *scene)),
    scene_(std::move(scene)),
    checker_(std::move(checker)),
    reference_(referenceState(*scene_))
{
  specs_.clearanceComputationType = ompl::base::StateValidityCheckerSpecs::EXACT;
}

bool StateValidityChecker::isValid(const ompl::base::State* state) const
{
  return validateStates({state}).front() != 0;
}

std::vector<std::uint8_t> StateValidityChecker::validateStates(
    const std::vector<const ompl::base::State*>& states) const
{
  std::vector<std::uint8_t> valid(states.size(), 0);
  std::vector<std::size_t> within;  // indices of the states within bounds
  std::vector<double> rows;
  rows.reserve(states.size() * reference_.size());
  for (std::size_t i = 0; i < states.size(); ++i)
  {
    if (!isWithin(*space_, states[i]))
      continue;
    appendRow(*space_, reference_, states[i], rows);
    within.push_back(i);
  }
  if (within.empty())
    return valid;
  const BatchResult result = checker_->check(rows.data(), within.size(), space_->group().name);
  states_checked_ += within.size();
  for (std::size_t k = 0; k < within.size(); ++k)
    valid[within[k]] = result.valid[k];
  return valid;
}

double StateValidityChecker::clearance(const ompl::base::State* state) const
{
  std::call_once(inspector_made_, [this] { inspector_ = std::make_unique<StateInspector>(scene_); });
  std::vector<double> row = reference_;
  space_->copyToRow(state, row.data());
  const Clearance clearance = inspector_->clearance(row.data(), space_->group().name);
  return std::min(clearance.world, clearance.self);
}
}  // namespace gpu_planning_scene::core
