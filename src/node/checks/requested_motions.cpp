#include "node/checks/requested_motions.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "base/math_constants.h"
#include "collision/bounds/reach.h"
#include "collision/problem/state_validation.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "model/joint_limits.h"

namespace gpu_planning_scene::core
{
namespace
{
/// The value of a field of the request: the largest step between two samples.
double requestedStep(const char* field, double value, const char* unit)
{
  if (std::isfinite(value) && value > 0.0)
    return value;
  std::ostringstream text;
  text << field << " is " << value << "; give the largest step between two samples: a finite number of " << unit
       << " above 0, for example 0.02";
  throw Error(text.str());
}
}  // namespace

std::pair<MotionCheckerOptions, std::size_t> requestedMotions(const RequestedMotions& request, const RobotModel& robot,
                                                              const double* starts, const double* ends,
                                                              std::size_t count, const CheckServicesOptions& limits)
{
  const std::size_t max_samples = limits.max_states;
  MotionCheckerOptions options;
  options.max_checks = limits.max_motion_checks;
  options.rule = request.rule.empty() ? limits.motion_rule : motionRuleFromName(request.rule);
  options.steps = {requestedStep("resolution", request.resolution, "radians"),
                   requestedStep("translation_resolution", request.translation_resolution, "metres")};
  if (options.rule == MotionRule::Samples)
    options.max_samples = max_samples;
  const std::size_t width = robot.variables().size();
  const std::string what = request.what;
  double all = 0.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double samples = segmentCount(robot, starts + i * width, ends + i * width, options.steps) + 1.0;
    all += samples;
    const std::string motion = what + " " + std::to_string(i);
    if (samples > static_cast<double>(options.max_samples))
      throw Error(motion + " has more than " + std::to_string(options.max_samples) + " samples; cut it into several " +
                  what + "s, or take larger steps");
    if (all > static_cast<double>(max_samples))
      throw Error("the " + what + "s up to " + motion + " have more than " + std::to_string(max_samples) +
                  " samples in total (limits/request_states); send fewer " + what + "s, or take larger steps");
  }
  return {options, static_cast<std::size_t>(all)};
}

std::string beyondLimits(const RobotModel& robot, const double* states, std::size_t count,
                         const std::function<std::string(std::size_t row)>& name_of)
{
  const std::size_t width = robot.variables().size();
  const std::vector<VariableRange> ranges = provenRanges(robot);
  for (std::size_t row = 0; row < count; ++row)
    if (const ValuesOutsideLimits outside = valuesOutside(ranges, robot, states + row * width); outside.count() != 0)
      return name_of(row) + ": " + outside.text() + "; the motion rule \"bound\" proves no motion there";
  return "";
}

std::string outsideLimits(const RobotModel& robot, const double* states, std::size_t count,
                          const std::function<std::string(std::size_t row)>& name_of)
{
  std::vector<int> columns(robot.variables().size());
  std::iota(columns.begin(), columns.end(), 0);
  const auto outside = findValueOutsideLimits(robot, columns, states, count);
  return outside ? name_of(outside->row) + ": " + outside->text : "";
}

std::string unproven(const std::vector<MotionVerdict>& motions, const std::string& what)
{
  const auto is_unproven = [](const MotionVerdict& motion)
  { return !motion.valid && !motion.given_up && motion.colliding == kNoPair; };
  const auto first = std::find_if(motions.begin(), motions.end(), is_unproven);
  if (first == motions.end())
    return "";
  return std::to_string(std::count_if(first, motions.end(), is_unproven)) + " of " + std::to_string(motions.size()) +
         " " + what + "s are neither proven free nor found in collision; the first is " + what + " " +
         std::to_string(first - motions.begin()) + ". Two bodies pass each other too closely for its length, as a " +
         "wheel and its floor do: allow this pair, move the object by some millimetres, or give shorter " + what + "s";
}

std::string givenUp(const std::vector<MotionVerdict>& motions, std::size_t max_checks, const std::string& what)
{
  const auto is_given_up = [](const MotionVerdict& motion) { return motion.given_up; };
  const auto first = std::find_if(motions.begin(), motions.end(), is_given_up);
  if (first == motions.end())
    return "";
  const auto count = std::count_if(first, motions.end(), is_given_up);
  return std::to_string(count) + " of " + std::to_string(motions.size()) + " " + what +
         "s are not proven free, because " + std::to_string(max_checks) +
         " checks (limits/motion_checks) did not suffice; the first is " + what + " " +
         std::to_string(first - motions.begin()) + "; send fewer or shorter " + what + "s in one request";
}

std::string longTurn(const RobotModel& robot, const std::vector<double>& path,
                     const std::function<std::string(std::size_t row)>& name_of)
{
  const std::size_t width = robot.variables().size();
  for (const Joint& joint : robot.joints())
  {
    const bool turns =
        joint.type == JointType::Planar || (joint.type == JointType::Continuous && isPeriodic(robot, joint));
    if (!turns || joint.mimic)
      continue;
    const auto column = static_cast<std::size_t>(joint.first_variable) + (joint.type == JointType::Planar ? 2U : 0U);
    for (std::size_t row = 1; row * width < path.size(); ++row)
      if (std::abs(path[row * width + column] - path[(row - 1) * width + column]) > kPi)
        return "joint '" + joint.name + "' moves by more than half a turn before " + name_of(row) +
               "; it is checked in the shorter direction: give more waypoints if it turns in the other one";
  }
  return "";
}
}  // namespace gpu_planning_scene::core
