#include "gpu_planning_scene/state_inspector.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include <pybind11/stl.h>

#include "bindings/arguments.h"
#include "bindings/bindings.h"
#include "bindings/interrupt.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::Clearance;
using core::Contact;
using core::PlanningScene;
using core::StateInspector;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kFirstPart = 64;  // states, which keep all cores busy

/// The clearances of one call; the arrays of Python are views of its memory.
struct Clearances
{
  std::vector<Clearance> all;
};

std::vector<Contact> contacts(const StateInspector& inspector, const py::object& state, const Arg<std::string>& group,
                              Arg<std::size_t> max_contacts, Arg<std::size_t> max_per_pair)
{
  const std::vector<double> row = rowFrom(state, *inspector.scene()->robot, "state", &inspector.scene()->current_state);
  return withoutLock([&]
                     { return inspector.contacts(row.data(), group.value, max_contacts.value, max_per_pair.value); });
}

/// Computes in parts that grow to a quarter of a second, between which Ctrl-C can end the call.
Clearances clearances(const StateInspector& inspector, const py::object& states, const Arg<std::string>& group)
{
  const core::RobotModel& robot = *inspector.scene()->robot;
  const Rows rows = rowsFrom(states, robot, "states", &inspector.scene()->current_state);
  const double* data = rows.data();
  const std::size_t width = robot.variables().size();
  Clearances result;
  Interrupt interrupt;
  withoutLock(
      [&]
      {
        std::size_t part = kFirstPart;
        for (std::size_t done = 0; done < rows.count && !interrupt.requested();)
        {
          const std::size_t count = std::min(part, rows.count - done);
          const Clock::time_point begin = Clock::now();
          const auto next = inspector.clearances(data + done * width, count, group.value);
          if (Clock::now() - begin < std::chrono::milliseconds(125))
            part *= 2;
          result.all.insert(result.all.end(), next.begin(), next.end());
          done += count;
        }
      });
  interrupt.rethrow();
  return result;
}

template <typename T, typename Member>
py::array membersOf(const py::object& self, Member Clearance::*member, bool is_pair)
{
  const auto& all = self.cast<const Clearances&>().all;
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(all.size())};
  std::vector<py::ssize_t> strides = {sizeof(Clearance)};
  if (is_pair)
  {
    shape.push_back(2);
    strides.push_back(sizeof(T));
  }
  return viewOf(all.empty() ? nullptr : reinterpret_cast<const T*>(&(all.front().*member)), shape, strides, self);
}

void addResults(py::module_& module)
{
  py::class_<Contact>(module, "Contact",
                      "A contact of two colliding bodies. Moving the second body along the "
                      "normal by the depth ends their collision.")
      .def_readonly("bodies", &Contact::bodies, "Two body indices, ascending.")
      .def_property_readonly(
          "point", [](const Contact& contact) { return toPython(contact.point); },
          "Metres, in the planning frame, shape (3,). Belongs to both bodies, up to 1e-6 m.")
      .def_property_readonly(
          "normal", [](const Contact& contact) { return toPython(contact.normal); },
          "Unit length, in the planning frame, from the first body to the second, shape (3,).")
      .def_readonly("depth", &Contact::depth, "Metres, above 0; for padded pairs it includes the required distance.");
  py::class_<Clearances>(module, "Clearances",
                         "The clearances of states, in metres beyond the required distance. The arrays show its "
                         "memory.")
      .def_property_readonly(
          "world", [](const py::object& self) { return membersOf<double>(self, &Clearance::world, false); },
          "Between the robot with its attached objects and the objects of the world: a lower bound, at most 1e-6 m "
          "below the true value. 0 in collision; inf if no pair is checked. Shape (n,).")
      .def_property_readonly(
          "self", [](const py::object& self) { return membersOf<double>(self, &Clearance::self, false); },
          "Within the robot and its attached objects, as world. Shape (n,).")
      .def_property_readonly(
          "nearest_world",
          [](const py::object& self) { return membersOf<std::int32_t>(self, &Clearance::nearest_world, true); },
          "The body indices of the nearest pair, ascending; -1, -1 if no pair is checked. Shape (n, 2), int32.")
      .def_property_readonly(
          "nearest_self",
          [](const py::object& self) { return membersOf<std::int32_t>(self, &Clearance::nearest_self, true); },
          "As nearest_world. Shape (n, 2), int32.")
      .def("__len__", [](const Clearances& result) { return result.all.size(); });
}
}  // namespace

void addStateInspector(py::module_& module)
{
  addResults(module);
  py::class_<StateInspector, std::shared_ptr<StateInspector>>(
      module, "StateInspector",
      "Computes contacts and clearances of states. A clearance takes about a hundred times as long as a check.\n\n"
      "scene: the inspector takes a copy. Thread-safe. Raises Error if the scene is not valid.\n\n"
      "    inspector = gps.StateInspector(scene)\n    print(inspector.clearances(states).world)")
      .def(py::init(
               [](const Arg<std::shared_ptr<PlanningScene>>& scene)
               {
                 const auto copy = std::make_shared<const PlanningScene>(*scene.value);
                 return withoutLock([&] { return std::make_shared<StateInspector>(copy); });
               }),
           py::arg("scene"))
      .def("contacts", &contacts, py::arg("state"), py::arg("group") = "", py::arg("max_contacts") = 100,
           py::arg("max_per_pair") = 0,
           "The contacts of the pairs that collide in a state: a list of Contact.\n\nstate: shape (variables,), or the "
           "name of a state. group: "
           "as in StateChecker.check. max_contacts: the most contacts in all. max_per_pair: the most for each pair; 0: "
           "no "
           "limit. The deepest contact of each pair comes "
           "first. Raises Error for another shape, an unknown group, and values that are not finite.\n\n"
           "    for contact in inspector.contacts(state):\n        print(contact.point, contact.depth)")
      .def("clearances", &clearances, py::arg("states"), py::arg("group") = "",
           "The clearances of states, computed on all cores.\n\nstates: as in StateChecker.check. group: "
           "as in StateChecker.check. Returns Clearances. Raises Error as contacts does. Ctrl-C ends a long call.");
}
}  // namespace gpu_planning_scene::python
