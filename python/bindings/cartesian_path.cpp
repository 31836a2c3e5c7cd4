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
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/inverse_kinematics.h"
#include "gpu_planning_scene/planning/cartesian_path.h"
#include "scene/link_frame.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::CartesianPath;
using core::CartesianQuery;

CartesianPath followLines(const Arg<CheckerPtr>& checker, const Arg<std::string>& group, const py::object& start,
                          const py::sequence& waypoints, const py::object& frame, Arg<double> max_step,
                          Arg<double> max_rotation_step, Arg<double> max_deviation, Arg<double> max_rotation_deviation,
                          Arg<double> max_joint_step, Arg<bool> check_collisions, const Arg<std::string>& rule,
                          const py::object& path_constraints)
{
  const auto scene = checker.value->scene();
  const core::RobotModel& robot = *scene->robot;
  CartesianQuery query;
  query.group = group.value;
  query.start = rowFrom(start, robot, "start", &scene->current_state);
  const core::LinkFrame moved = frame.is_none() ? core::LinkFrame{core::tipOf(robot, robot.group(query.group))}
                                                : core::linkFrame(*scene, frame.cast<Arg<std::string>>().value);
  query.link = moved.link;
  query.frame = moved.pose;
  for (std::size_t i = 0; i < py::len(waypoints); ++i)
    query.waypoints.push_back(poseFrom(waypoints[i], "waypoint " + std::to_string(i)));
  query.max_step = max_step.value;
  query.max_rotation_step = max_rotation_step.value;
  query.max_deviation = max_deviation.value;
  query.max_rotation_deviation = max_rotation_deviation.value;
  query.max_joint_step = max_joint_step.value;
  query.check_collisions = check_collisions.value;
  query.motions.rule = core::motionRuleFromName(rule.value);
  for (const core::KinematicConstraints& constraints : constraintsFrom(path_constraints, *scene, "path_constraints"))
    query.path_constraints.append(constraints);
  Interrupt interrupt;
  CartesianPath path = withoutLock(
      [&]
      {
        const SharedChecker::Call call(*checker.value);
        if (call.scene() != scene)
          throw core::Error("the scene of the checker was replaced meanwhile; call follow_lines again");
        return core::followLines(scene, call.checker(), query, [&] { return interrupt.requested(); });
      });
  interrupt.rethrow();
  return path;
}

py::array_t<double> rowsOf(const CartesianPath& path)
{
  py::array_t<double> rows({path.rows.size(), path.rows.front().size()});
  double* out = rows.mutable_data();
  for (const std::vector<double>& row : path.rows)
    out = std::copy(row.begin(), row.end(), out);
  return rows;
}
}  // namespace

void addCartesianPath(py::module_& module)
{
  const CartesianQuery defaults;
  py::class_<CartesianPath>(module, "CartesianPath", "The answer of follow_lines.")
      .def_readonly("fraction", &CartesianPath::fraction, "The part of the lines that the path follows, from 0 to 1.")
      .def_readonly("message", &CartesianPath::message,
                    "Why the path ends earlier, in one line; empty if the fraction is 1.")
      .def_property_readonly("waypoints", &rowsOf,
                             "The start and the states along the lines, shape (k, variables). The straight motions "
                             "between them are free by the motion rule.")
      .def_readonly("states_checked", &CartesianPath::states_checked)
      .def_readonly("revision", &CartesianPath::revision, "PlanningScene.revision of the checked scene.");
  module.def(
      "follow_lines", &followLines, py::arg("checker"), py::arg("group"), py::arg("start"), py::arg("waypoints"),
      py::arg("frame") = py::none(), py::arg("max_step") = defaults.max_step,
      py::arg("max_rotation_step") = defaults.max_rotation_step, py::arg("max_deviation") = defaults.max_deviation,
      py::arg("max_rotation_deviation") = defaults.max_rotation_deviation,
      py::arg("max_joint_step") = defaults.max_joint_step, py::arg("check_collisions") = true,
      py::arg("rule") = "bound", py::arg("path_constraints") = py::none(),
      "A path along which a frame moves on straight lines, from its pose in `start` through the waypoints.\n\n"
      "start: shape (variables,), or the name of a state of the SRDF. waypoints: poses in the planning frame, each as "
      "PlanningScene.add_object takes it. frame: a link, an object that a link carries, or its subframe; None: the "
      "last link of the group's chain. max_step (metres) and max_rotation_step (radians): between states of the path. "
      "max_deviation (metres) and max_rotation_deviation (radians): from the line, between these states too. "
      "max_joint_step: a joint that would move by more (radians, metres) between two states, even if the step is "
      "halved to a hundredth, ends the path: it would jump. check_collisions: False: only kinematics and limits. rule: "
      "as in MotionChecker. path_constraints: a KinematicConstraints, or a list of them, that the whole path "
      "fulfils.\n\nReturns a CartesianPath: lines that cannot be followed to their end are no exception. Raises Error "
      "for an unknown group or frame, a group with a base that drives only along its heading, a start out of "
      "bounds, and values that are not valid. Ctrl-C ends the call.\n\n"
      "    pose = scene.frame(\"palm\")\n"
      "    pose[2, 3] += 0.1\n"
      "    path = gps.follow_lines(checker, \"arm\", start, [pose])\n"
      "    print(path.fraction, path.message)");
}
}  // namespace gpu_planning_scene::python
