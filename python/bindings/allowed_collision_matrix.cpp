#include "gpu_planning_scene/allowed_collision_matrix.h"

#include <memory>

#include <pybind11/stl.h>

#include "bindings/arguments.h"
#include "bindings/bindings.h"

namespace gpu_planning_scene::python
{
void addAllowedCollisionMatrix(py::module_& module)
{
  using core::AllowedCollisionMatrix;
  using Name = Arg<std::string>;
  py::class_<AllowedCollisionMatrix>(
      module, "AllowedCollisionMatrix",
      "Names the pairs of bodies (links and objects) that may touch. An entry for the pair decides. Without an entry, "
      "the defaults of the two bodies decide; if both have one, both must allow the pair. A pair without an entry and "
      "without a default is checked.\n\n    scene.allowed_collisions.set_entry(\"can\", \"table\", True)")
      .def(py::init<>(), "A matrix without entries: all pairs are checked.")
      .def_static(
          "from_robot",
          [](const Arg<std::shared_ptr<core::RobotModel>>& robot)
          { return AllowedCollisionMatrix::fromRobot(*robot.value); },
          py::arg("robot"), "The matrix of the SRDF. Without an SRDF, it allows adjacent links to touch.")
      .def(
          "set_entry",
          [](AllowedCollisionMatrix& matrix, const Name& body_1, const Name& body_2, Arg<bool> allowed)
          { matrix.setEntry(body_1.value, body_2.value, allowed.value); },
          py::arg("body_1"), py::arg("body_2"), py::arg("allowed"),
          "Sets the entry of a pair. The order of the two names does not matter.")
      .def(
          "set_default",
          [](AllowedCollisionMatrix& matrix, const Name& body, Arg<bool> allowed)
          { matrix.setDefault(body.value, allowed.value); },
          py::arg("body"), py::arg("allowed"), "Sets the default of a body, for pairs without an entry.")
      .def(
          "remove_entry",
          [](AllowedCollisionMatrix& matrix, const Name& body) { return matrix.removeEntry(body.value); },
          py::arg("body"),
          "Removes all entries of a body and its default. Returns the bodies whose contact with it was forbidden, and "
          "is allowed by their own default from now on.")
      .def(
          "allowed",
          [](const AllowedCollisionMatrix& matrix, const Name& body_1, const Name& body_2)
          { return matrix.allowed(body_1.value, body_2.value); },
          py::arg("body_1"), py::arg("body_2"), "Whether the two bodies may touch.")
      .def_property_readonly("bodies", &AllowedCollisionMatrix::bodies,
                             "The names of all bodies with an entry or a default, sorted.")
      .def(
          "default_of",
          [](const AllowedCollisionMatrix& matrix, const Name& body) { return matrix.defaultOf(body.value); },
          py::arg("body"), "The default of a body, or None.")
      .def(
          "allowed_partners",
          [](const AllowedCollisionMatrix& matrix, const Name& body) { return matrix.allowedPartners(body.value); },
          py::arg("body"), "The bodies that an entry allows to touch this body, sorted.")
      .def(
          "__eq__", [](const AllowedCollisionMatrix& a, const AllowedCollisionMatrix& b) { return a == b; },
          py::is_operator());
}
}  // namespace gpu_planning_scene::python
