#include "gpu_planning_scene/planning/motion_validator.h"

#include <string>
#include <utility>

#include "planning/space/group_space.h"

namespace gpu_planning_scene::core
{
namespace
{
// Some 200 bytes each.
constexpr std::size_t kMostRemembered = 100'000;

MotionCheckerOptions coarser(MotionCheckerOptions options)
{
  options.rule = MotionRule::Samples;
  options.steps.revolute *= MotionValidator::kCoarser;
  options.steps.prismatic *= MotionValidator::kCoarser;
  return options;
}
}  // namespace

MotionValidator::MotionValidator(const ompl::base::SpaceInformationPtr& information,
                                 std::shared_ptr<const PlanningScene> scene, std::shared_ptr<StateChecker> checker,
                                 const MotionCheckerOptions& options)
  : ompl::base::MotionValidator(information),
    space_(groupSpaceOf(*information, *scene)),
    reference_(referenceState(*scene)),
    motions_(checker, scene->robot, space_->group().name, options),
    coarse_motions_(std::move(checker), scene->robot, space_->group().name, coarser(options))
{
}

bool MotionValidator::project(ompl::base::State* state) const
{
  std::vector<double> row;
  appendRow(*space_, reference_, state, row);
  if (!constraints_->project(row.data()))
    return false;
  space_->copyFromRow(row.data(), state);
  return true;
}

/// Motions that leave the bounds or violate the constraints are not checked for collision.
std::vector<MotionVerdict> MotionValidator::check(const MotionChecker& checker, const std::vector<Motion>& motions,
                                                  MotionQuery query, const Termination& ptc) const
{
  std::vector<std::size_t> within;
  std::vector<double> starts;
  std::vector<double> ends;
  for (std::size_t i = 0; i < motions.size(); ++i)
  {
    const auto& [from, to] = motions[i];
    if (!isWithin(*space_, from) || !isWithin(*space_, to))
      continue;
    const std::size_t begin = starts.size();
    appendRow(*space_, reference_, from, starts);
    appendRow(*space_, reference_, to, ends);
    if (constraints_ && !constraints_->holdAlong(&starts[begin], &ends[begin]))
    {
      starts.resize(begin);
      ends.resize(begin);
      continue;
    }
    within.push_back(i);
  }
  const std::vector<MotionVerdict> checked =
      checker.check(starts.data(), ends.data(), within.size(), query, [&ptc] { return ptc(); });
  std::vector<MotionVerdict> verdicts(motions.size());
  for (std::size_t i = 0; i < within.size(); ++i)
    verdicts[within[i]] = checked[i];
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const MotionVerdict& verdict : verdicts)
    ++(verdict.valid ? valid_ : invalid_);
  return verdicts;
}

bool MotionValidator::checkMotion(const ompl::base::State* from, const ompl::base::State* to) const
{
  return check(motions_, {{from, to}}, MotionQuery::Valid, never()).front().valid;
}

bool MotionValidator::checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                                  std::pair<ompl::base::State*, double>& last_valid) const
{
  const MotionVerdict verdict = check(motions_, {{from, to}}, MotionQuery::LastValid, never()).front();
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
  if (!remembers_)
    return validOf(check(motions_, motions, MotionQuery::Valid, ptc));
  const auto key_of = [this](const Motion& motion)
  {
    std::vector<double> values;
    std::string key;
    for (const ompl::base::State* state : {motion.first, motion.second})
    {
      space_->copyToReals(values, state);
      key.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
    }
    return key;
  };
  std::vector<std::uint8_t> valid(motions.size(), 1);
  std::vector<std::size_t> unknown;
  std::vector<Motion> unknown_motions;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t i = 0; i < motions.size(); ++i)
      if (valid_motions_.count(key_of(motions[i])) == 0)
      {
        unknown.push_back(i);
        unknown_motions.push_back(motions[i]);
      }
  }
  const std::vector<MotionVerdict> verdicts = check(motions_, unknown_motions, MotionQuery::Valid, ptc);
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t i = 0; i < unknown.size(); ++i)
    if (!verdicts[i].valid)
      valid[unknown[i]] = 0;
    else if (valid_motions_.size() < kMostRemembered)
      valid_motions_.insert(key_of(unknown_motions[i]));
  return valid;
}

std::vector<std::uint8_t> MotionValidator::validateCoarsely(const std::vector<Motion>& motions,
                                                            const Termination& ptc) const
{
  return validOf(check(coarse_motions_, motions, MotionQuery::Valid, ptc));
}

std::vector<std::uint8_t> MotionValidator::validateExtensions(const std::vector<Motion>& motions,
                                                              const Termination& ptc) const
{
  return validOf(check(coarse_motions_, motions, MotionQuery::Extension, ptc));
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
