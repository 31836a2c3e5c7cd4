#include "gpu_planning_scene/state_inspector.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
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
using core::BodyDistance;
using core::BodyDistances;
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

/// Computes `work(states, count)` in parts that grow to a quarter of a second, between which Ctrl-C can end the call.
template <class Work>
void inParts(const Rows& rows, std::size_t width, const Work& work)
{
  const double* data = rows.data();
  Interrupt interrupt;
  withoutLock(
      [&]
      {
        std::size_t part = kFirstPart;
        for (std::size_t done = 0; done < rows.count && !interrupt.requested();)
        {
          const std::size_t count = std::min(part, rows.count - done);
          const Clock::time_point begin = Clock::now();
          work(data + done * width, count);
          if (Clock::now() - begin < std::chrono::milliseconds(125))
            part *= 2;
          done += count;
        }
      });
  interrupt.rethrow();
}

Clearances clearances(const StateInspector& inspector, const py::object& states, const Arg<std::string>& group)
{
  const core::RobotModel& robot = *inspector.scene()->robot;
  Clearances result;
  inParts(rowsFrom(states, robot, "states", &inspector.scene()->current_state), robot.variables().size(),
          [&](const double* part, std::size_t count)
          {
            const auto next = inspector.clearances(part, count, group.value);
            result.all.insert(result.all.end(), next.begin(), next.end());
          });
  return result;
}

/// The distances of one call, and the number of columns of their gradients.
struct Distances
{
  BodyDistances all;
  std::vector<std::int64_t> states;  // of each pair
  std::size_t width = 0;
};

Distances distances(const StateInspector& inspector, const py::object& states, const Arg<std::string>& group,
                    Arg<double> range, Arg<bool> nearest_of_each_body, Arg<bool> gradients, Arg<bool> signed_distance)
{
  const core::RobotModel& robot = *inspector.scene()->robot;
  const core::DistanceQuery query = {range.value, nearest_of_each_body.value, gradients.value, signed_distance.value};
  Distances result;
  result.width = gradients.value ? robot.variables().size() : 0;
  std::int64_t state = 0;
  const auto append = [&](const double* part, std::size_t count)
  {
    const BodyDistances next = inspector.distances(part, count, group.value, query);
    BodyDistances& all = result.all;
    all.pairs.insert(all.pairs.end(), next.pairs.begin(), next.pairs.end());
    all.gradients.insert(all.gradients.end(), next.gradients.begin(), next.gradients.end());
    for (std::size_t i = 0; i < count; ++i, ++state)
      result.states.insert(result.states.end(), next.first[i + 1] - next.first[i], state);
  };
  const Rows rows = rowsFrom(states, robot, "states", &inspector.scene()->current_state);
  withoutLock([&] { append(rows.data(), 0); });  // finds a fault of the query also without states
  inParts(rows, robot.variables().size(), append);
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

/// A view of a member of all pairs; `inner`: the shape of the member, which contains only T.
template <typename T, typename Member>
py::array ofPairs(const py::object& self, Member BodyDistance::*member, const std::vector<py::ssize_t>& inner)
{
  const std::vector<BodyDistance>& all = self.cast<const Distances&>().all.pairs;
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(all.size())};
  std::vector<py::ssize_t> strides = {sizeof(BodyDistance)};
  py::ssize_t size = sizeof(Member);
  for (const py::ssize_t length : inner)
  {
    size /= length;
    shape.push_back(length);
    strides.push_back(size);
  }
  return viewOf(all.empty() ? nullptr : reinterpret_cast<const T*>(&(all.front().*member)), shape, strides, self);
}

void addDistances(py::module_& module)
{
  py::class_<Distances>(module, "BodyDistances",
                        "The distances of pairs of bodies in states, in metres and in the planning frame. The pairs of "
                        "a state follow each other. The arrays show its memory.")
      .def_property_readonly(
          "state",
          [](const py::object& self)
          {
            const auto& states = self.cast<const Distances&>().states;
            return viewOf(states.data(), {static_cast<py::ssize_t>(states.size())}, {sizeof(std::int64_t)}, self);
          },
          "The number of the state of each pair, ascending. Shape (n,), int64.")
      .def_property_readonly(
          "bodies", [](const py::object& self) { return ofPairs<std::int32_t>(self, &BodyDistance::bodies, {2}); },
          "Body indices; the first is a link or an attached object. Shape (n, 2), int32.")
      .def_property_readonly(
          "collides", [](const py::object& self) { return ofPairs<bool>(self, &BodyDistance::collides, {}); },
          "Whether the bodies collide. Shape (n,), bool.")
      .def_property_readonly(
          "distance", [](const py::object& self) { return ofPairs<double>(self, &BodyDistance::distance, {}); },
          "Metres: the gap between the bodies minus the required distance, at most 1e-6 m below the true value and "
          "never above it; a pair that is free may have 0. In collision: minus the depth of the deepest contact. "
          "Shape (n,).")
      .def_property_readonly(
          "depth_at_least",
          [](const py::object& self) { return ofPairs<double>(self, &BodyDistance::depth_at_least, {}); },
          "Metres. In collision: no shorter translation separates the bodies. 0: no such length is known. Shape (n,).")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            return ofPairs<double>(self, &BodyDistance::points, {2, 3});
          },
          "The nearest points of the two surfaces without padding; in collision, both are the point of the deepest "
          "contact. Shape (n, 2, 3).")
      .def_property_readonly(
          "normal", [](const py::object& self) { return ofPairs<double>(self, &BodyDistance::normal, {3}); },
          "Unit length, from the first body to the second. NaN if the surfaces touch without a collision, and in "
          "collision without signed_distance. Shape (n, 3).")
      .def_property_readonly(
          "gradient",
          [](const py::object& self)
          {
            const auto& result = self.cast<const Distances&>();
            const auto width = static_cast<py::ssize_t>(result.width);
            constexpr auto size = static_cast<py::ssize_t>(sizeof(double));
            return viewOf(result.all.gradients.data(),
                          {static_cast<py::ssize_t>(width == 0 ? 0 : result.all.pairs.size()), width},
                          {width * size, size}, self);
          },
          "The derivatives of the distance by the variables, in metres per radian or metre. A row without a normal is "
          "NaN. Shape (n, variables), or (0, 0) without gradients.")
      .def(
          "__len__", [](const Distances& result) { return result.all.pairs.size(); });
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
  addDistances(module);
  py::class_<StateInspector, std::shared_ptr<StateInspector>>(
      module, "StateInspector",
      "Computes contacts, clearances and distances of states. A clearance takes about a hundred times as long as a "
      "check.\n\n"
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
           "as in StateChecker.check. Returns Clearances. Raises Error as contacts does. Ctrl-C ends a long call.")
      .def(
          "distances", &distances, py::arg("states"), py::arg("group") = "",
          py::arg("range") = std::numeric_limits<double>::infinity(), py::arg("nearest_of_each_body") = false,
          py::arg("gradients") = true, py::arg("signed_distance") = true,
          "The distances of the bodies of states, with nearest points, normals and gradients, computed on all "
          "cores.\n\nstates: as in StateChecker.check; one row is one state. group: as there. range: metres, above 0; "
          "pairs that are not nearer are left out. nearest_of_each_body: only the nearest pair of each link and "
          "attached object, which takes much "
          "less time. signed_distance: False: pairs in collision have the distance 0, and neither points nor a normal, "
          "which takes less time. Returns BodyDistances. Raises Error as contacts does, and if the range "
          "is not above 0. Ctrl-C ends a long call.\n\n"
          "    near = inspector.distances(states, range=0.1)\n    print(near.distance, near.gradient)");
}
}  // namespace gpu_planning_scene::python
