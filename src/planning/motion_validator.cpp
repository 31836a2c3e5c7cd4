#include "gpu_planning_scene/planning/motion_validator.h"

#include <utility>

#include "planning/group_space.h"

namespace gpu_planning_scene::core
{
MotionValidator::MotionValidator(const ompl::base::SpaceInformationPtr& information,
                                 std::shared_ptr<const PlanningScene> scene, std::shared_ptr<StateChecker> checker,
                                 const MotionCheckerOptions& options)
  : ompl::base::MotionValidator(information),
    space_(groupSpaceOf(*information, *scene)),
    reference_(referenceState(*scene)),
    motions_(std::move(checker), scene->robot, space_->group().name, options)
{
}

/// Motions that leave the bounds are not checked.
std::vector<MotionVerdict> MotionValidator::check(const std::vector<Motion>& motions, MotionQuery query,
                                                  const Termination& ptc) const
{
  std::vector<std::size_t> within;
  std::vector<double> starts;
  std::vector<double> ends;
  for (std::size_t i = 0; i < motions.size(); ++i)
  {
    const auto& [from, to] = motions[i];
    if (!isWithin(*space_, from) || !isWithin(*space_, to))
      continue;
    appendRow(*space_, reference_, from, starts);
    appendRow(*space_, reference_, to, ends);
    within.push_back(i);
  }
  const std::vector<MotionVerdict> checked =
      motions_.check(starts.data(), ends.data(), within.size(), query, [&ptc] { return ptc(); });
  std::vector<MotionVerdict> verdicts(motions.size());
  for (std::size_t i = 0; i < within.size(); ++i)
    verdicts[within[i]] = checked[i];
  const std::lock_guard<std::mutex> lock(counters_);
  for (const MotionVerdict& verdict : verdicts)
    ++(verdict.valid ? valid_ : invalid_);
  return verdicts;
}

bool MotionValidator::checkMotion(const ompl::base::State* from, const ompl::base::State* to) const
{
  return check({{from, to}}, MotionQuery::Valid, never()).front().valid;
}

bool MotionValidator::checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                                  std::pair<ompl::base::State*, double>& last_valid) const
{
  const MotionVerdict verdict = check({{from, to}}, MotionQuery::LastValid, never()).front();
  if (verdict.valid)
    return true;
  last_valid.second = verdict.last_valid;
  if (last_valid.first)
    si_->getStateSpace()->interpolate(from, to, verdict.last_valid, last_valid.first);
  return false;
}

std::vector<std::uint8_t> MotionValidator::validOf(const std::vector<MotionVerdict>& verdicts)
{
  std::vector<std::uint8_t> valid;
  valid.reserve(verdicts.size());
  for (const MotionVerdict& verdict : verdicts)
    valid.push_back(verdict.valid ? 1 : 0);
  return valid;
}

std::vector<std::uint8_t> MotionValidator::validateMotions(const std::vector<Motion>& motions,
                                                           const Termination& ptc) const
{
  return validOf(check(motions, MotionQuery::Valid, ptc));
}

std::vector<std::uint8_t> MotionValidator::validateSamples(const std::vector<Motion>& motions,
                                                           const Termination& ptc) const
{
  return validOf(check(motions, MotionQuery::Samples, ptc));
}

bool MotionValidator::validatePath(const ompl::geometric::PathGeometric& path, const Termination& ptc) const
{
  std::vector<Motion> motions;
  for (std::size_t i = 0; i + 1 < path.getStateCount(); ++i)
    motions.emplace_back(path.getState(static_cast<unsigned int>(i)), path.getState(static_cast<unsigned int>(i + 1)));
  if (motions.empty() && path.getStateCount() == 1)
    motions.emplace_back(path.getState(0), path.getState(0));
  for (const std::uint8_t valid : validateMotions(motions, ptc))
    if (valid == 0)
      return false;
  return path.getStateCount() != 0;
}
}  // namespace gpu_planning_scene::core
