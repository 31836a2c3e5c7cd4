#include "gpu_planning_scene/motion_checker.h"

#include <utility>

#include "collision/motion/motion_batch.h"
#include "collision/motion/motions_of_group.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"

// Validates the motions. MotionBatch checks them, by the method of Schwarzer, Saha and Latombe (2002).
namespace gpu_planning_scene::core
{
MotionRule motionRuleFromName(const std::string& name)
{
  if (name == "samples")
    return MotionRule::Samples;
  if (name == "bound")
    return MotionRule::Bound;
  throw Error("the motion rule is '" + name + "'; it must be samples or bound");
}

MotionChecker::MotionChecker(std::shared_ptr<StateChecker> checker, std::shared_ptr<const RobotModel> robot,
                             std::string group, const MotionCheckerOptions& options)
  : checker_(std::move(checker)), robot_(std::move(robot)), group_(std::move(group)), options_(options)
{
  validateSteps(options_.steps);
}

std::vector<MotionVerdict> MotionChecker::check(const double* starts, const double* ends, std::size_t count,
                                                MotionQuery query, const std::function<bool()>& stop) const
{
  validateStates(*robot_, starts, count);
  validateStates(*robot_, ends, count);
  requireMotionsOfGroup(*robot_, group_, starts, ends, count, "motion");
  MotionCheckerOptions options = options_;
  if (query == MotionQuery::Samples || query == MotionQuery::Extension)
    options.rule = MotionRule::Samples;
  const std::size_t width = robot_->variables().size();
  MotionBatch batch(*checker_, *robot_, group_, options, query, stop);
  for (std::size_t i = 0; i < count; ++i)
    batch.add(starts + i * width, ends + i * width);
  batch.checkSamples();
  if (options.rule == MotionRule::Bound && !robot_->joints().empty())
    batch.prove();
  states_checked_ += batch.statesChecked();
  return batch.verdicts();
}
}  // namespace gpu_planning_scene::core
