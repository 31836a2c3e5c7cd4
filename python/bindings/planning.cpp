#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <ompl/util/Console.h>
#include <pybind11/stl.h>

#include "bindings/arguments.h"
#include "bindings/bindings.h"
#include "bindings/interrupt.h"
#include "bindings/kinematic_constraints.h"
#include "bindings/motion_checker.h"
#include "bindings/named_rows.h"
#include "bindings/state_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/planning/batch_rrt_connect.h"
#include "gpu_planning_scene/planning/group_state_space.h"
#include "gpu_planning_scene/planning/plan_motion.h"
#include "model/joint_limits.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::PlanningQuery;
using core::PlanningResult;
using core::PlanningStatus;

/// Values as OMPL's parameters have them.
std::map<std::string, std::string> parametersFrom(py::handle parameters)
{
  std::map<std::string, std::string> texts;
  if (parameters.is_none())
    return texts;
  if (!py::isinstance<py::dict>(parameters))
    throwTypeError("parameters: " + expectedButGot("a dict", parameters));
  for (const auto& [name, value] : py::reinterpret_borrow<py::dict>(parameters))
    texts[py::str(name)] = py::str(value);
  return texts;
}

/// 0 for None.
std::uint32_t seedFrom(const py::object& seed)
{
  if (seed.is_none())
    return 0;
  const std::uint64_t value = seed.cast<Arg<std::uint64_t>>().value;
  if (value == 0 || value > std::numeric_limits<std::uint32_t>::max())
    throw core::Error("the seed is " + std::to_string(value) + "; it must be from 1 to 4294967295");
  return static_cast<std::uint32_t>(value);
}

std::optional<Eigen::AlignedBox3d> workspaceFrom(const py::object& workspace)
{
  if (workspace.is_none())
    return std::nullopt;
  const bool is_pair =
      (py::isinstance<py::tuple>(workspace) || py::isinstance<py::list>(workspace)) && py::len(workspace) == 2;
  if (!is_pair)
    throwTypeError("workspace: " + expectedButGot("a pair of corners, ((x, y, z), (x, y, z))", workspace));
  const Eigen::AlignedBox3d box(vectorFrom(workspace[py::int_(0)], "workspace: the lower corner"),
                                vectorFrom(workspace[py::int_(1)], "workspace: the upper corner"));
  if (!box.min().allFinite() || !box.max().allFinite() || box.isEmpty())
    throw core::Error("workspace: the corners must be finite, and the first must not be above the second");
  return box;
}

/// Full states, one per goal. Of the states that the SRDF names, only the variables of the group count: a state `home`
/// of an arm and its hand is also a goal of the arm.
std::vector<std::vector<double>> goalsFrom(const py::object& goals, const PlanningQuery& query,
                                           const std::shared_ptr<const core::RobotModel>& robot)
{
  const Rows rows = rowsFrom(goals, *robot, "goals", &query.start);
  const std::size_t width = query.start.size();
  std::vector<std::vector<double>> states;
  for (std::size_t i = 0; i < rows.count; ++i)
    states.emplace_back(rows.data() + i * width, rows.data() + (i + 1) * width);
  const std::vector<std::string> names = namesFrom(goals);
  if (names.empty())
    return states;
  requireNamesOfGroup(names, *robot, query.group, "goals");
  const core::GroupStateSpace space(robot, query.group, query.workspace);
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    const std::vector<double> named = std::exchange(states[i], query.start);
    for (const int variable : space.variables())
      states[i][static_cast<std::size_t>(variable)] = named[static_cast<std::size_t>(variable)];
  }
  return states;
}

PlanningResult planMotion(const Arg<CheckerPtr>& checker, const Arg<std::string>& group, const py::object& start,
                          const py::object& goals, Arg<double> seconds, Arg<bool> simplify,
                          const Arg<std::string>& rule, Arg<double> resolution, Arg<double> translation_resolution,
                          Arg<std::size_t> max_samples, const py::object& parameters, const py::object& seed,
                          const py::object& workspace, Arg<double> optimize, const py::object& goal_constraints,
                          const py::object& path_constraints)
{
  const auto scene = checker.value->scene();
  PlanningQuery query;
  query.group = group.value;
  query.start = rowFrom(start, *scene->robot, "start", &scene->current_state);
  query.seconds = seconds.value;
  query.simplify = simplify.value;
  query.motions = motionOptionsFrom(rule, resolution, translation_resolution, max_samples);
  query.parameters = parametersFrom(parameters);
  query.seed = seedFrom(seed);
  query.workspace = workspaceFrom(workspace);
  if (!goals.is_none())
    query.goals = goalsFrom(goals, query, scene->robot);
  query.goal_regions = constraintsFrom(goal_constraints, *scene, "goal_constraints");
  for (const core::KinematicConstraints& constraints : constraintsFrom(path_constraints, *scene, "path_constraints"))
    query.path_constraints.append(constraints);
  query.optimize_seconds = optimize.value;
  // The planner itself refuses values of the group beyond the limits.
  if (const std::string outside =
          core::otherValueOutsideLimits(*scene->robot, scene->robot->group(query.group).variables, query.start.data());
      !outside.empty())
    warnOf({"start: " + outside});
  Interrupt interrupt;
  PlanningResult result = withoutLock(
      [&]
      {
        const SharedChecker::Call call(*checker.value);  // so that the whole plan is made in one scene
        return core::planMotion(call.scene(), call.checker(), query, core::PlannerFactoryOf<core::BatchRrtConnect>(),
                                [&] { return interrupt.requested(); });
      });
  interrupt.rethrow();
  return result;
}

py::array_t<double> waypointsOf(const PlanningResult& result)
{
  const std::size_t width = result.waypoints.empty() ? 0 : result.waypoints.front().size();
  py::array_t<double> rows({result.waypoints.size(), width});
  double* out = rows.mutable_data();
  for (const std::vector<double>& waypoint : result.waypoints)
    out = std::copy(waypoint.begin(), waypoint.end(), out);
  return rows;
}
}  // namespace

void addPlanning(py::module_& module)
{
  ompl::msg::setLogLevel(ompl::msg::LOG_WARN);  // its information would stand between the lines of a program
  const core::MotionCheckerOptions motions;
  py::enum_<PlanningStatus>(module, "PlanningStatus", "How a planning call ended.")
      .value("SOLVED", PlanningStatus::Solved)
      .value("APPROXIMATE", PlanningStatus::Approximate, "The path ends at the reached state nearest to a goal.")
      .value("NO_SOLUTION", PlanningStatus::NoSolution)
      .value("START_IN_COLLISION", PlanningStatus::StartInCollision)
      .value("GOAL_IN_COLLISION", PlanningStatus::GoalInCollision)
      .value("OUT_OF_BOUNDS", PlanningStatus::OutOfBounds)
      .value("GOAL_UNREACHABLE", PlanningStatus::GoalUnreachable,
             "Inverse kinematics found no state that fulfils goal_constraints.")
      .value("START_VIOLATES_CONSTRAINTS", PlanningStatus::StartViolatesConstraints)
      .value("GOAL_VIOLATES_CONSTRAINTS", PlanningStatus::GoalViolatesConstraints);
  py::class_<PlanningResult>(module, "PlanningResult", "The answer of plan_motion.")
      .def_readonly("status", &PlanningResult::status)
      .def_readonly("message", &PlanningResult::message, "The fault, in one line; empty if the status is SOLVED.")
      .def_property_readonly("waypoints", &waypointsOf,
                             "States, shape (k, variables); none unless the status is SOLVED or APPROXIMATE. The "
                             "straight motions between them are free by the motion rule.")
      .def_readonly("planning_seconds", &PlanningResult::planning_seconds)
      .def_readonly("simplification_seconds", &PlanningResult::simplification_seconds)
      .def_readonly("checking_seconds", &PlanningResult::checking_seconds,
                    "Seconds of the checker, within planning_seconds and simplification_seconds, summed over all "
                    "searches.")
      .def_readonly("states_checked", &PlanningResult::states_checked)
      .def_readonly("revision", &PlanningResult::revision, "PlanningScene.revision of the checked scene.");
  module.def(
      "plan_motion", &planMotion, py::arg("checker"), py::arg("group"), py::arg("start"), py::arg("goals") = py::none(),
      py::arg("seconds") = PlanningQuery().seconds, py::arg("simplify") = true, py::arg("rule") = "bound",
      py::arg("resolution") = motions.steps.revolute, py::arg("translation_resolution") = motions.steps.prismatic,
      py::arg("max_samples") = motions.max_samples, py::arg("parameters") = py::none(), py::arg("seed") = py::none(),
      py::arg("workspace") = py::none(), py::arg("optimize") = 0.0, py::arg("goal_constraints") = py::none(),
      py::arg("path_constraints") = py::none(),
      "Plans a motion of a planning group in the scene of a StateChecker, with the planner BatchRrtConnect.\n\n"
      "start: shape (variables,). goals: shape (n, variables) or (variables,); the motion may end at any of "
      "them. Both can be names of states of the SRDF: variables that the start does not set have their values from the "
      "scene's current_state, and variables that a goal does not set have theirs from the start. Variables outside the "
      "group keep their values from the start: a row of goals must have the same values for them, and of a named goal "
      "they do not count. seconds: for planning; "
      "simplification and the last check of the path come afterwards. simplify: shortens the path. rule, "
      "resolution, translation_resolution, max_samples: as in MotionChecker. parameters: of the planner, by "
      "OMPL's names, for example {\"range\": 0.5}. seed: from 1 to 4294967295; calls with the same seed "
      "give the same path, unless a time limit ends a search or a proof, or another thread plans without a seed "
      "meanwhile. If the parameter max_rounds ends a search before `seconds` do, a failure is the same each time too. "
      "Calls with a seed run one after the other. workspace: a pair of corners (xyz, xyz), the range in metres in "
      "which "
      "planar and floating joints of the group are planned for; None: that of unbounded_translation. "
      "optimize: seconds in which the path is made shorter after simplification. goal_constraints: a "
      "KinematicConstraints, or a list of them: the motion may also end in any state that fulfils one of them, for "
      "example at a pose. path_constraints: the whole motion fulfils them.\n\nReturns a "
      "PlanningResult: a motion that "
      "is not found is not an exception. Raises Error for an unknown group or parameter, for other shapes, for "
      "values that are not finite, and for a goal that moves a variable outside the group, or is a named state "
      "without variables of the group. Ctrl-C ends the call. A checker serves one call after the other.\n\n"
      "    result = gps.plan_motion(checker, \"arm\", start, goal)\n"
      "    print(result.status, result.message, result.waypoints)");
}
}  // namespace gpu_planning_scene::python
