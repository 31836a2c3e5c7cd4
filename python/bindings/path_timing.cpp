#include <algorithm>
#include <string>
#include <vector>

#include <pybind11/stl.h>

#include "bindings/arguments.h"
#include "bindings/bindings.h"
#include "bindings/interrupt.h"
#include "bindings/kinematic_constraints.h"
#include "bindings/motion_checker.h"
#include "bindings/state_checker.h"
#include "gpu_planning_scene/planning/path_timing.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::TimedPath;
using core::TimedPoint;

TimedPath timePath(const Arg<CheckerPtr>& checker, const Arg<std::string>& group, const py::object& waypoints,
                   Arg<double> velocity_factor, Arg<double> acceleration_factor, Arg<double> max_deviation,
                   const Arg<std::string>& rule, Arg<double> resolution, Arg<double> translation_resolution,
                   Arg<std::size_t> max_samples, const py::object& path_constraints)
{
  const auto scene = checker.value->scene();
  const Rows rows = rowsFrom(waypoints, *scene->robot, "waypoints", &scene->current_state);
  const std::size_t width = scene->robot->variables().size();
  std::vector<std::vector<double>> path;
  for (std::size_t i = 0; i < rows.count; ++i)
    path.emplace_back(rows.data() + i * width, rows.data() + (i + 1) * width);
  core::PathTimingOptions options{velocity_factor.value, acceleration_factor.value, max_deviation.value,
                                  motionOptionsFrom(rule, resolution, translation_resolution, max_samples)};
  for (const core::KinematicConstraints& constraints : constraintsFrom(path_constraints, *scene, "path_constraints"))
    options.path_constraints.append(constraints);
  Interrupt interrupt;
  TimedPath result = withoutLock(
      [&]
      {
        const SharedChecker::Call call(*checker.value);
        return core::timePath(*call.scene(), call.checker(), group.value, path, options,
                              [&] { return interrupt.requested(); });
      });
  interrupt.rethrow();
  return result;
}

/// An array with one row of the member for each point.
py::array_t<double> rowsOf(const TimedPath& path, std::vector<double> TimedPoint::*member)
{
  py::array_t<double> rows({path.points.size(), (path.points.front().*member).size()});
  double* out = rows.mutable_data();
  for (const TimedPoint& point : path.points)
    out = std::copy((point.*member).begin(), (point.*member).end(), out);
  return rows;
}

py::array_t<double> timesOf(const TimedPath& path)
{
  py::array_t<double> times(static_cast<py::ssize_t>(path.points.size()));
  std::transform(path.points.begin(), path.points.end(), times.mutable_data(),
                 [](const TimedPoint& point) { return point.seconds; });
  return times;
}
}  // namespace

void addPathTiming(py::module_& module)
{
  const core::PathTimingOptions defaults;
  const core::MotionCheckerOptions& motions = defaults.motions;
  py::class_<TimedPath>(module, "TimedPath",
                        "The answer of time_path: points of a motion. Between two points, the acceleration is that of "
                        "the first one.")
      .def_property_readonly("times", &timesOf, "Seconds from the start, shape (k,).")
      .def_property_readonly(
          "positions", [](const TimedPath& path) { return rowsOf(path, &TimedPoint::positions); },
          "Shape (k, variables), as velocities and accelerations; radians and metres.")
      .def_property_readonly(
          "velocities", [](const TimedPath& path) { return rowsOf(path, &TimedPoint::velocities); },
          "Per second; 0 at the first and the last point.")
      .def_property_readonly(
          "accelerations", [](const TimedPath& path) { return rowsOf(path, &TimedPoint::accelerations); },
          "Per second squared.")
      .def_readonly("message", &TimedPath::message,
                    "The variables with assumed limits, in one line; empty if there are none.")
      .def_readonly("blends", &TimedPath::blends, "Number of waypoints that are passed on a curve beside them.")
      .def_readonly("stops", &TimedPath::stops, "Number of waypoints between the start and the goal with a stop.")
      .def_readonly("seconds", &TimedPath::seconds, "Seconds of the computation.")
      .def_readonly("checking_seconds", &TimedPath::checking_seconds, "Seconds of the checker.")
      .def_readonly("states_checked", &TimedPath::states_checked);
  module.def(
      "time_path", &timePath, py::arg("checker"), py::arg("group"), py::arg("waypoints"),
      py::arg("max_velocity_scaling_factor") = defaults.max_velocity_scaling_factor,
      py::arg("max_acceleration_scaling_factor") = defaults.max_acceleration_scaling_factor,
      py::arg("max_deviation") = defaults.max_deviation, py::arg("rule") = "bound",
      py::arg("resolution") = motions.steps.revolute, py::arg("translation_resolution") = motions.steps.prismatic,
      py::arg("max_samples") = motions.max_samples, py::arg("path_constraints") = py::none(),
      "Computes times for a path, for example that of plan_motion, under the limits of the joints.\n\n"
      "waypoints: shape (k, variables). The straight motions between them are not checked again. At a waypoint, each "
      "joint leaves the path by at most max_deviation (radians, metres) on a curve that is valid by the motion rule, "
      "or the robot stops there: docs/planning.md explains the method. For a path of follow_lines, give the "
      "max_deviation of follow_lines (1e-4 by default): the default of time_path is 500 times larger, and would round "
      "the corners of the lines by much more than they allow. path_constraints: those of plan_motion or follow_lines; "
      "the robot then stops where the path turns, as with max_deviation 0, because the curves could leave the "
      "constraints. max_velocity_scaling_factor, "
      "max_acceleration_scaling_factor: fractions of the limits, above 0 and at most 1. rule, resolution, "
      "translation_resolution, max_samples: as in MotionChecker.\n\nReturns a TimedPath. Raises Error for an unknown "
      "group, a group with a floating joint, numbers out of their ranges, values that are not finite, and a motion of "
      "joints outside the group. Ctrl-C ends the call.\n\n"
      "    timed = gps.time_path(checker, \"arm\", result.waypoints)\n"
      "    print(timed.times[-1], timed.message)");
}
}  // namespace gpu_planning_scene::python
