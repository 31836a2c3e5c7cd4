#include "node/planning/plan_request.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/text/name_list.h"
#include "base/text/number_text.h"
#include "base/text/parse_number.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "model/full_states.h"
#include "model/joint_limits.h"
#include "node/checks/state_warnings.h"
#include "node/parameters/parameter_values.h"
#include "node/planning/requested_goals.h"
#include "planning/space/waypoints.h"

namespace gpu_planning_scene::core
{
namespace
{
/// Throws Error if a column of the goals is not a variable of the group's state space.
void requirePlannedFor(const std::vector<int>& columns, const GroupStateSpace& space)
{
  for (const int column : columns)
    if (std::find(space.variables().begin(), space.variables().end(), column) == space.variables().end())
      throw Error("goal_names has " + space.robot()->variables()[static_cast<std::size_t>(column)].name +
                  ", which group '" + space.group().name + "' does not plan for");
}

/// The state of the SRDF, without variables outside the group: a state `home` of an arm and its hand is also a goal of
/// the arm.
NamedRow namedGoal(const PlanMotion::Request& request, const GroupStateSpace& space)
{
  const RobotModel& robot = *space.robot();
  const NamedRow state = requestedNamedState(robot, {"named_goal", request.named_goal},
                                             !request.goal_names.empty() ? "goal_names"
                                             : !request.goals.empty()    ? "goals"
                                                                         : nullptr);
  NamedRow goal;
  for (std::size_t i = 0; i < state.names.size(); ++i)
    if (std::find(space.variables().begin(), space.variables().end(), robot.variableIndex(state.names[i])) !=
        space.variables().end())
    {
      goal.names.push_back(state.names[i]);
      goal.values.push_back(state.values[i]);
    }
  if (goal.names.empty())
    throw Error("named_goal '" + request.named_goal + "' has no variable of the group '" + request.group + "'");
  return goal;
}

/// The workspace of the request; no value if it has none.
std::optional<Eigen::AlignedBox3d> workspaceOf(const WorkspaceParameters& parameters, const std::string& planning_frame)
{
  const auto& min = parameters.min_corner;
  const auto& max = parameters.max_corner;
  const Eigen::AlignedBox3d box(Eigen::Vector3d(min.x, min.y, min.z), Eigen::Vector3d(max.x, max.y, max.z));
  if (box.min().isZero(0.0) && box.max().isZero(0.0))
    return std::nullopt;
  if (!box.min().allFinite() || !box.max().allFinite() || box.isEmpty())
    throw Error("workspace_parameters: the corners must be finite, and min_corner must not be above max_corner");
  const std::string& frame = parameters.header.frame_id;
  if (!frame.empty() && frame != planning_frame && frame != "/" + planning_frame)
    throw Error("workspace_parameters are in the frame '" + frame + "'; give them in the planning frame '" +
                planning_frame + "'");
  return box;
}

/// Refuses parameters that keep a planner busy for hours between two checks of the time, because planners accept any
/// number. Examples are a count of many millions, and a `range` that is a billionth of the extent of the space.
void refuseCostly(const std::map<std::string, std::string>& parameters, double extent, std::size_t limit)
{
  constexpr double kLeastRange = 1e-4;  // fraction of the extent
  for (const auto& [name, text] : parameters)
  {
    const std::optional<double> value = parseNumber(text);
    if (!value)
      continue;
    if (!(*value >= 0.0 && *value <= static_cast<double>(limit)))
      throw Error("the planner's parameter " + name + " is " + text + "; it must be from 0 to " +
                  std::to_string(limit) + " (limits/planner_parameter)");
    if (name == "range" && *value > 0.0 && *value < kLeastRange * extent)
      throw Error("the planner's parameter range is " + text +
                  "; it must be 0, for the planner to choose, or at least " + std::to_string(kLeastRange * extent) +
                  ", a 10,000th of the extent of the group's space");
  }
}
/// Whether a whole turn of the variable leads to the same robot state.
bool isWrapped(const RobotModel& robot, int variable)
{
  return std::any_of(
      robot.joints().begin(), robot.joints().end(),
      [variable](const Joint& joint) { return !joint.mimic && wrappedAngle(joint) == variable; });
}
/// A warning if the named start of a request replaces known values of variables outside the group; otherwise empty.
std::string startBeyondGroup(const PlanMotion::Request& request, const Snapshot& now, const std::vector<double>& start)
{
  constexpr double kWrittenDecimals = 1e-6;  // radians or metres: values of an SRDF are often written with six decimals
  if (request.named_start.empty())
    return "";
  const RobotModel& robot = *now.scene->robot;
  const std::vector<int>& of_group = robot.group(request.group).variables;
  const auto differs = [&](std::size_t i)
  {
    const double change = start[i] - now.state[i];
    return std::abs(isWrapped(robot, static_cast<int>(i)) ? std::remainder(change, 2.0 * M_PI) : change) >
           kWrittenDecimals;
  };
  std::vector<std::string> moved;
  for (std::size_t i = 0; i < start.size(); ++i)
    if (now.known[i] && differs(i) &&
        std::find(of_group.begin(), of_group.end(), static_cast<int>(i)) == of_group.end())
      moved.push_back(robot.variables()[i].name + " (" + numberText(start[i]) + " instead of " +
                      numberText(now.state[i]) + ")");
  if (moved.empty())
    return "";
  const auto is_of_group = [&request](const NamedState& state)
  { return state.group == request.group && state.name == request.named_start; };
  const bool has_own = std::any_of(robot.namedStates().begin(), robot.namedStates().end(), is_of_group);
  return "named_start '" + request.named_start + "' also sets variables outside the group '" + request.group +
         "', which have other values now: " + nameList(moved) + "; to keep them, " +
         (has_own ? "name '" + request.group + "/" + request.named_start + "'" : "give start_names and start");
}
}  // namespace

PlanServiceOptions planOptionsFromParameters(const ros::NodeHandle& own)
{
  constexpr std::size_t kMaxAtOnce = 64;
  constexpr std::size_t kMaxKnownPaths = 1000;  // each plan compares its start and its goals with all of them
  constexpr std::size_t kNoLimit = std::size_t{1} << 31;
  PlanServiceOptions options;
  options.seconds = positiveParameter(own, "planning/time", options.seconds);
  options.max_seconds = positiveParameter(own, "limits/planning_time", options.max_seconds);
  const std::string rule = textParameter(own, "planning/motion_rule", "bound");
  try
  {
    options.motions.rule = motionRuleFromName(rule);
  }
  catch (const Error& error)
  {
    throw Error("parameter " + own.resolveName("planning/motion_rule") + ": " + error.what());
  }
  MotionSteps& steps = options.motions.steps;
  steps.revolute = positiveParameter(own, "planning/resolution", steps.revolute);
  steps.prismatic = positiveParameter(own, "planning/translation_resolution", steps.prismatic);
  options.max_deviation = lengthParameter(own, "planning/max_deviation", options.max_deviation);
  options.at_once = countParameter(own, "planning/at_once", options.at_once, 1, kMaxAtOnce);
  options.known_paths = countParameter(own, "planning/known_paths", options.known_paths, 0, kMaxKnownPaths);
  options.max_waiting = countParameter(own, "limits/waiting_plans", options.max_waiting, 0, kNoLimit);
  options.max_goals = countParameter(own, "limits/goals", options.max_goals, 1, kNoLimit);
  options.max_parameter = countParameter(own, "limits/planner_parameter", options.max_parameter, 1, kNoLimit);
  return options;
}

RequestedState requestedStart(const PlanMotion::Request& request, const Snapshot& now)
{
  const RobotModel& robot = *now.scene->robot;
  RequestedState start =
      requestedState(robot, {"start_names", request.start_names}, {"start", request.start},
                     {"named_start", request.named_start}, now.partialState(), "the start of the motion");
  requireWholeRotations(robot, start.columns);
  return start;
}

PlanningQuery queryFrom(const PlanMotion::Request& request, const Snapshot& now, const RequestedState& start,
                        const PlannerConfig& config, const GroupPlanners& planners, const PlanServiceOptions& options)
{
  const RobotModel& robot = *now.scene->robot;
  PlanningQuery query;
  query.group = request.group;
  query.start = start.state;
  const auto few = [&options](std::size_t count)
  {
    if (count > options.max_goals)
      throw Error(std::to_string(count) + " goals are more than " + std::to_string(options.max_goals) +
                  " (limits/goals)");
  };
  query.workspace = workspaceOf(request.workspace_parameters, robot.planningFrame());
  const GroupStateSpace space(now.scene->robot, request.group, query.workspace);
  NamedRow goal_rows{request.goal_names, request.goals};
  if (!request.named_goal.empty())
    goal_rows = namedGoal(request, space);
  if (!goal_rows.names.empty() || !goal_rows.values.empty() || !hasGoalRegions(request))
  {
    const std::vector<int> columns =
        requestedColumns(robot, {"goal_names", goal_rows.names}, {"goals", goal_rows.values}, few);
    requirePlannedFor(columns, space);
    requireWholeRotations(robot, columns);
    const std::size_t width = columns.size();
    const PartialState others(robot, query.start);
    const std::size_t goals = goal_rows.values.size() / width;
    const std::vector<double> rows = fullStates(robot, columns, goal_rows.values.data(), goals, others);
    for (std::size_t i = 0; i < goals; ++i)
      query.goals.emplace_back(rows.begin() + static_cast<std::ptrdiff_t>(i * query.start.size()),
                               rows.begin() + static_cast<std::ptrdiff_t>((i + 1) * query.start.size()));
  }

  query.seconds = request.allowed_planning_time == 0.0 ? options.seconds : request.allowed_planning_time;
  if (query.seconds > options.max_seconds)
    throw Error("allowed_planning_time is " + std::to_string(query.seconds) + " s; the limit is " +
                std::to_string(options.max_seconds) + " (limits/planning_time)");
  query.simplify = request.simplify;
  query.optimize_seconds = request.optimize;
  if (!(query.optimize_seconds >= 0.0 && query.optimize_seconds <= options.max_seconds))
    throw Error("optimize is " + std::to_string(query.optimize_seconds) + " s; it must be from 0 to " +
                std::to_string(options.max_seconds) + " (limits/planning_time)");
  query.motions = options.motions;
  if (!request.motion_rule.empty())
    query.motions.rule = motionRuleFromName(request.motion_rule);
  if (const auto& fraction = planners.longest_valid_segment_fraction)
  {
    const double step = *fraction * space.getMaximumExtent();
    query.motions.steps = {step, step};
  }
  if (request.resolution != 0.0)
    query.motions.steps.revolute = request.resolution;
  if (request.translation_resolution != 0.0)
    query.motions.steps.prismatic = request.translation_resolution;
  query.parameters = config.parameters;
  std::set<std::string> given;
  for (const auto& parameter : request.parameters)
  {
    if (!given.insert(parameter.key).second)
      throw Error("parameter '" + parameter.key + "' is given twice");
    query.parameters[parameter.key] = parameter.value;
  }
  refuseCostly(query.parameters, space.getMaximumExtent(), options.max_parameter);
  query.projection = planners.projection;
  return query;
}

std::vector<std::string> planWarnings(const PlanMotion::Request& request, const Snapshot& now,
                                      const RequestedState& start)
{
  std::vector<std::string> warnings;
  addStateWarnings(now, request.group, start, "the start", warnings);
  if (std::string beyond = startBeyondGroup(request, now, start.state); !beyond.empty())
    warnings.push_back(std::move(beyond));
  if (request.goal_names.empty())
    return warnings;
  const RobotModel& robot = *now.scene->robot;
  if (const auto turned = findManyTurns(robot, variableIndices(robot, request.goal_names), request.goals.data(),
                                        request.goals.size() / request.goal_names.size()))
    warnings.push_back("goal " + std::to_string(turned->row) + ": " + turned->text);
  return warnings;
}
}  // namespace gpu_planning_scene::core
