#include "bindings/motion_checker.h"

#include <memory>
#include <utility>
#include <vector>

#include "bindings/bindings.h"
#include "bindings/interrupt.h"
#include "bindings/named_rows.h"
#include "bindings/state_checker.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/interpolation.h"
#include "gpu_planning_scene/planning/trajectory_watch.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::MotionChecker;
using core::MotionCheckerOptions;
using core::MotionQuery;
using core::MotionVerdict;

/// The answers of one call; the arrays of Python are views of its memory.
struct MotionVerdicts
{
  std::vector<MotionVerdict> all;
};

/// A checker of motions with its robot, which gives the rows their width. The robot never changes, see
/// SharedChecker::setScene.
struct SharedMotionChecker
{
  SharedMotionChecker(CheckerPtr shared, const std::string& group, const MotionCheckerOptions& options)
    : checker(std::move(shared)),
      robot(checker->scene()->robot),
      motions(SharedChecker::Call(*checker).checker(), robot, group, options)
  {
    if (!group.empty())
      robot->group(group);  // throws Error for an unknown group
  }

  CheckerPtr checker;
  std::shared_ptr<const core::RobotModel> robot;
  MotionChecker motions;
};

MotionQuery queryFrom(const std::string& name)
{
  if (name == "valid")
    return MotionQuery::Valid;
  if (name == "last_valid")
    return MotionQuery::LastValid;
  if (name == "samples")
    return MotionQuery::Samples;
  throw core::Error("the query is '" + name + "'; it must be valid, last_valid or samples");
}

MotionVerdicts checkMotions(const SharedMotionChecker& checker, const py::object& starts, const py::object& ends,
                            const Arg<std::string>& query)
{
  const MotionQuery question = queryFrom(query.value);
  const auto scene = checker.checker->scene();
  const Rows from = rowsFrom(starts, *checker.robot, "starts", &scene->current_state);
  const Rows to = endsFrom(ends, from, *checker.robot);
  if (from.count != to.count)
    throw core::Error("there are " + std::to_string(from.count) + " starts and " + std::to_string(to.count) +
                      " ends; give one end for each start");
  const double* from_data = from.data();
  const double* to_data = to.data();
  if (const std::string sideways = core::sidewaysMotion(*checker.robot, from_data, to_data, from.count, "motion");
      !sideways.empty())
    throw core::Error(sideways);
  Interrupt interrupt;
  auto verdicts = withoutLock(
      [&]
      {
        const SharedChecker::Call call(*checker.checker);  // so that all of the motions are checked in one scene
        return checker.motions.check(from_data, to_data, from.count, question, [&] { return interrupt.requested(); });
      });
  interrupt.rethrow();
  warnOfValuesOutsideLimits(from, *checker.robot, "starts");
  warnOfValuesOutsideLimits(to, *checker.robot, "ends");
  return {std::move(verdicts)};
}

core::MotionOutlook outlookAt(const SharedMotionChecker& checker, const std::vector<double>& seconds,
                              const py::object& states, Arg<double> now)
{
  const core::RobotModel& robot = *checker.robot;
  const Rows rows = rowsFrom(states, robot, "states", nullptr);
  core::WatchedTrajectory trajectory;
  const std::size_t width = robot.variables().size();
  for (std::size_t i = 0; i < width; ++i)
    trajectory.columns.push_back(static_cast<int>(i));
  trajectory.rows = {seconds, {rows.data(), rows.data() + rows.count * width}};
  core::validateTrajectory(trajectory);
  const std::vector<double> none(width, 0.0);  // no variable is without a trajectory
  return withoutLock(
      [&]
      {
        const SharedChecker::Call call(*checker.checker);
        return outlookOf(checker.motions, robot, motionOfAll(robot, {&trajectory}, {0.0}, none, now.value));
      });
}

/// An array of one member of all verdicts, whose values are `width` numbers of type T.
template <typename T, typename Member>
py::array membersOf(const py::object& self, Member MotionVerdict::*member, py::ssize_t width = 0)
{
  const auto& all = self.cast<const MotionVerdicts&>().all;
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(all.size())};
  std::vector<py::ssize_t> strides = {sizeof(MotionVerdict)};
  if (width > 0)
  {
    shape.push_back(width);
    strides.push_back(sizeof(T));
  }
  return viewOf(all.empty() ? nullptr : reinterpret_cast<const T*>(&(all.front().*member)), shape, strides, self);
}
}  // namespace

MotionCheckerOptions motionOptionsFrom(const Arg<std::string>& rule, Arg<double> resolution,
                                       Arg<double> translation_resolution, Arg<std::size_t> max_samples)
{
  MotionCheckerOptions options;
  options.rule = core::motionRuleFromName(rule.value);
  options.steps = {resolution.value, translation_resolution.value};
  core::validateSteps(options.steps);
  options.max_samples = max_samples.value;
  return options;
}

void addMotionChecker(py::module_& module)
{
  const MotionCheckerOptions defaults;
  py::class_<MotionVerdicts>(
      module, "MotionVerdicts",
      "The answers of MotionChecker.check, one for each motion. The arrays are views of its memory.")
      .def_property_readonly(
          "valid", [](const py::object& self) { return membersOf<bool>(self, &MotionVerdict::valid); },
          "True: the motion is valid. Shape (n,), bool.")
      .def_property_readonly(
          "last_valid", [](const py::object& self) { return membersOf<double>(self, &MotionVerdict::last_valid); },
          "The fraction of the motion, 0 to 1, up to which it is valid. Only the query \"last_valid\" computes it: "
          "with "
          "the other queries, it is 0 for each motion that is not valid. Shape (n,).")
      .def_property_readonly(
          "first_invalid",
          [](const py::object& self) { return membersOf<double>(self, &MotionVerdict::first_invalid); },
          "The fraction of the sample that collides, or around which the motion is not proven free; 1 if the motion "
          "is valid. Shape (n,).")
      .def_property_readonly(
          "colliding",
          [](const py::object& self) { return membersOf<std::int32_t>(self, &MotionVerdict::colliding, 2); },
          "The body indices of the colliding pair at first_invalid; -1, -1 if the check found no sample that collides. "
          "Shape (n, 2), int32.")
      .def_property_readonly(
          "given_up", [](const py::object& self) { return membersOf<bool>(self, &MotionVerdict::given_up); },
          "True: max_checks ended the checks of this motion too early. Shape (n,), bool.")
      .def("__len__", [](const MotionVerdicts& verdicts) { return verdicts.all.size(); });
  using core::MotionOutlook;
  py::class_<MotionOutlook>(
      module, "MotionOutlook",
      "What is known about the rest of a trajectory: the answer of MotionChecker.outlook. Times are those of its rows.")
      .def_readonly("free", &MotionOutlook::free, "True: the rest is free by the checker's rule.")
      .def_readonly("free_until", &MotionOutlook::free_until, "Seconds: the trajectory is free up to this time.")
      .def_readonly("collision", &MotionOutlook::collision,
                    "Seconds: the first sample that collides, or around which the rest is not proven free; inf if the "
                    "rest is free.")
      .def_readonly("colliding", &MotionOutlook::colliding,
                    "The body indices of a pair that collides then; -1, -1 if the rest is only not proven free.")
      .def_readonly("brake_by", &MotionOutlook::brake_by,
                    "Seconds: the latest time at which the robot can begin to brake along the trajectory so that it "
                    "stands at free_until. The limits are Variable.max_acceleration, 1 if there is none. inf if the "
                    "rest is free, -inf if it is too late.");
  py::class_<SharedMotionChecker>(
      module, "MotionChecker",
      "Checks straight motions between states, many at once.\n\nchecker: a StateChecker; the motions are checked in "
      "its scene. group: as in StateChecker.check. rule: \"bound\" proves that a motion is free between its samples, "
      "too; \"samples\" checks only the samples, as MoveIt and OMPL do. resolution, translation_resolution: the "
      "largest step between samples, in radians and metres. max_samples: a motion that needs more samples is not "
      "valid. max_checks: the largest number of state checks of one call; None: no limit. With \"bound\", a motion "
      "is invalid, and both fractions are 0, if a joint of its start or end is beyond its limits.\n\nRaises Error for "
      "an "
      "unknown group or rule and for a step that is not above 0.\n\n"
      "    motions = gps.MotionChecker(checker, rule=\"samples\")\n"
      "    print(motions.check(states[:-1], states[1:]).valid)")
      .def(py::init(
               [](const Arg<CheckerPtr>& checker, const Arg<std::string>& group, const Arg<std::string>& rule,
                  Arg<double> resolution, Arg<double> translation_resolution, Arg<std::size_t> max_samples,
                  const py::object& max_checks)
               {
                 auto options = motionOptionsFrom(rule, resolution, translation_resolution, max_samples);
                 if (!max_checks.is_none())
                   options.max_checks = max_checks.cast<Arg<std::size_t>>().value;
                 // A running check holds the checker and needs the interpreter's lock now and then.
                 return withoutLock(
                     [&] { return std::make_unique<SharedMotionChecker>(checker.value, group.value, options); });
               }),
           py::arg("checker"), py::arg("group") = "", py::arg("rule") = "bound",
           py::arg("resolution") = defaults.steps.revolute,
           py::arg("translation_resolution") = defaults.steps.prismatic, py::arg("max_samples") = defaults.max_samples,
           py::arg("max_checks") = py::none())
      .def("check", &checkMotions, py::arg("starts"), py::arg("ends"), py::arg("query") = "valid",
           "Checks straight motions.\n\nstarts, ends: shape (n, variables) or (variables,), radians and metres, or "
           "names of states of the SRDF. Variables that a named start does not set have their values from the scene's "
           "current_state; those that a named end does not set, from its start. query: "
           "\"valid\" ends at the first collision; \"last_valid\" also finds up to which fraction a motion is valid; "
           "\"samples\" uses the rule \"samples\". Returns MotionVerdicts.\n\nRaises Error for other shapes, for "
           "another number of ends, and for values that are not finite. Ctrl-C ends a long call.")
      .def("outlook", &outlookAt, py::arg("seconds"), py::arg("states"), py::arg("now"),
           "Checks what is still to come of a trajectory that a robot executes, for example after a change of the "
           "scene (StateChecker.set_scene).\n\nseconds: the times of the rows, increasing. states: shape "
           "(n, variables), radians and metres; between two rows, the motion is straight. now: seconds; what has "
           "passed by then does not count. Make the checker without a group, so that all pairs count. Returns a "
           "MotionOutlook.\n\nRaises Error for times that do not increase, for other shapes, and for values that "
           "are not finite.")
      .def_property_readonly(
          "states_checked", [](const SharedMotionChecker& self) { return self.motions.statesChecked(); },
          "Number of states checked so far, with and without margins.");
}
}  // namespace gpu_planning_scene::python
