#include "bindings/shapes.h"

#include <memory>
#include <type_traits>
#include <utility>

#include "bindings/arguments.h"
#include "bindings/bindings.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/resources.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::Box;
using core::Cone;
using core::Cylinder;
using core::HalfSpace;
using core::Mesh;
using core::Shape;
using core::Sphere;

template <typename T>
T valid(const T& shape, const char* where)
{
  core::validateShape(shape, where);
  return shape;
}

std::shared_ptr<Mesh> meshFrom(py::handle vertices, py::handle triangles, const Arg<std::string>& name,
                               const Arg<std::string>& solid)
{
  const auto mesh = std::make_shared<Mesh>();
  mesh->name = name.value;
  mesh->solid = core::solidRuleFrom(solid.value);
  const ArrayOf<double> points = arrayFrom(vertices, "the vertices of a mesh");
  const py::array indices = anyArrayFrom(triangles);
  if (!indices || std::string("iu").find(indices.dtype().kind()) == std::string::npos)
    throwTypeError("the triangles of a mesh: " + expectedButGot("an array of whole numbers", triangles));
  const ArrayOf<std::int64_t> corners(indices);
  if (points.ndim() != 2 || points.shape(1) != 3 || corners.ndim() != 2 || corners.shape(1) != 3)
    throw core::Error("the arrays of a mesh have the shapes " + std::string(py::str(points.attr("shape"))) + " and " +
                      std::string(py::str(corners.attr("shape"))) +
                      "; they must be (vertices, 3) and (triangles, 3), with indices of vertices");
  mesh->vertices.resize(points.shape(0));
  for (py::ssize_t i = 0; i < points.shape(0); ++i)
    mesh->vertices[i] = Eigen::Vector3d(points.data(i, 0));
  mesh->triangles.resize(corners.shape(0));
  for (py::ssize_t i = 0; i < corners.shape(0); ++i)
    for (int k = 0; k < 3; ++k)
    {
      const std::int64_t corner = corners.at(i, k);
      if (corner < 0 || corner >= points.shape(0))
        throw core::Error("triangle " + std::to_string(i) + " of a mesh names vertex " + std::to_string(corner) +
                          ", but there are " + std::to_string(points.shape(0)) + " vertices");
      mesh->triangles[i][k] = static_cast<std::uint32_t>(corner);
    }
  core::validateMesh(*mesh);
  return mesh;
}

std::shared_ptr<Mesh> meshFromFile(py::handle path, py::handle scale, const Arg<std::string>& solid)
{
  Eigen::Vector3d factors = Eigen::Vector3d::Ones();
  if (PyNumber_Check(scale.ptr()) != 0 && PySequence_Check(scale.ptr()) == 0)
    factors *= scale.cast<double>();
  else
    factors = vectorFrom(scale, "the scale of a mesh");
  const std::string file = pathFrom(path, "the path of a mesh");
  const core::SolidRule rule = core::solidRuleFrom(solid.value);
  std::vector<core::PlacedShape> shapes = {{withoutLock([&] { return core::MeshCache().load(file, factors); })}};
  core::setSolidRule(shapes, rule);
  return std::const_pointer_cast<Mesh>(std::get<std::shared_ptr<const Mesh>>(shapes.front().shape));
}

/// Adds the properties radius and length.
template <typename T>
void addRound(py::module_& module, const char* name, const char* doc, const char* where)
{
  py::class_<T>(module, name, doc)
      .def(py::init(
               [where](Arg<double> radius, Arg<double> length) {
                 return valid(T{radius.value, length.value}, where);
               }),
           py::arg("radius"), py::arg("length"))
      .def_readonly("radius", &T::radius, "Metres.")
      .def_readonly("length", &T::length, "Metres, along z.");
}

bool isPair(py::handle object)
{
  return py::isinstance<py::tuple>(object) && py::len(object) == 2;
}

Shape shapeFrom(py::handle object, const std::string& where)
{
  if (py::isinstance<Box>(object))
    return object.cast<Box>();
  if (py::isinstance<Sphere>(object))
    return object.cast<Sphere>();
  if (py::isinstance<Cylinder>(object))
    return object.cast<Cylinder>();
  if (py::isinstance<Cone>(object))
    return object.cast<Cone>();
  if (py::isinstance<HalfSpace>(object))
    return object.cast<HalfSpace>();
  if (py::isinstance<Mesh>(object))
    return std::shared_ptr<const Mesh>(object.cast<std::shared_ptr<Mesh>>());
  throwTypeError(where + ": " + expectedButGot("a Box, Sphere, Cylinder, Cone, Mesh or HalfSpace", object));
}
}  // namespace

std::vector<core::PlacedShape> shapesFrom(py::handle object, const std::string& where)
{
  if (py::isinstance<py::list>(object))
  {
    std::vector<core::PlacedShape> shapes;
    for (const py::handle item : object)
      if (isPair(item))
        shapes.push_back({shapeFrom(item[py::int_(0)], where), poseFrom(item[py::int_(1)], where)});
      else
        shapes.push_back({shapeFrom(item, where)});
    return shapes;
  }
  py::list list;
  list.append(object);
  return shapesFrom(list, where);
}

py::object toPython(const Shape& shape)
{
  return std::visit(
      [](const auto& known) -> py::object
      {
        if constexpr (std::is_same_v<std::decay_t<decltype(known)>, std::shared_ptr<const Mesh>>)
          return py::cast(std::const_pointer_cast<Mesh>(known));
        else
          return py::cast(known);
      },
      shape);
}

py::list toPython(const std::vector<core::PlacedShape>& shapes)
{
  py::list list;
  for (const core::PlacedShape& shape : shapes)
    list.append(py::make_tuple(toPython(shape.shape), toPython(shape.pose)));
  return list;
}

void addShapes(py::module_& module)
{
  py::class_<Box>(module, "Box",
                  "A box, centred at the origin of its frame.\n\nsize: edge lengths along x, y and z in metres.\n\n"
                  "Raises Error unless each length is above 0 and at most 1e6.\n\n    gps.Box([0.4, 0.2, 0.1])")
      .def(py::init([](const py::object& size) { return valid(Box{vectorFrom(size, "the size of a box")}, "a box"); }),
           py::arg("size"))
      .def_property_readonly(
          "size", [](const Box& box) { return toPython(box.size); }, "Edge lengths in metres, shape (3,).");
  py::class_<Sphere>(module, "Sphere",
                     "A sphere, centred at the origin of its frame.\n\nradius: metres.\n\nRaises Error unless the "
                     "radius is above 0 and at most 1e6.\n\n    gps.Sphere(0.1)")
      .def(py::init([](Arg<double> radius) { return valid(Sphere{radius.value}, "a sphere"); }), py::arg("radius"))
      .def_readonly("radius", &Sphere::radius, "Metres.");
  addRound<Cylinder>(module, "Cylinder",
                     "A cylinder along z, centred at the origin of its frame.\n\nradius, length: metres.\n\nRaises "
                     "Error unless both are above 0 and at most 1e6.\n\n    gps.Cylinder(radius=0.05, length=1.0)",
                     "a cylinder");
  addRound<Cone>(module, "Cone",
                 "A cone along z. Its apex is at z = length / 2, its base at z = -length / 2.\n\nradius, length: "
                 "metres.\n\nRaises Error unless both are above 0 and at most 1e6.\n\n"
                 "    gps.Cone(radius=0.1, length=0.3)",
                 "a cone");
  py::class_<HalfSpace>(module, "HalfSpace",
                        "All points x with normal . x <= offset: a plane and everything behind it. Links and attached "
                        "objects cannot have half-spaces.\n\nnormal: unit length. offset: metres.\n\nRaises Error "
                        "unless the normal has unit length.\n\n    floor = gps.HalfSpace([0, 0, 1], 0.0)")
      .def(
          py::init(
              [](const py::object& normal, Arg<double> offset) {
                return valid(HalfSpace{vectorFrom(normal, "the normal of a half-space"), offset.value}, "a half-space");
              }),
          py::arg("normal"), py::arg("offset"))
      .def_property_readonly(
          "normal", [](const HalfSpace& plane) { return toPython(plane.normal); }, "Unit length, shape (3,).")
      .def_readonly("offset", &HalfSpace::offset, "Metres.");
  py::class_<Mesh, std::shared_ptr<Mesh>>(
      module, "Mesh",
      "A triangle mesh in its own frame, of any topology. Parts that are closed, or whose holes are small, bound "
      "solids; "
      "others are surfaces. solid: \"auto\"; \"surface\", which has nothing inside; or \"filled\", which fills all "
      "holes. Objects that use the same Mesh share one tree.\n\nvertices: metres, shape (v, 3). triangles: indices "
      "of vertices, shape (t, 3). name: the origin of the mesh, for messages. The arrays are copied.\n\nRaises Error "
      "for other shapes, without a triangle, for a vertex that is not finite, and for an index out of range.\n\n"
      "    gps.Mesh([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0]], [[0, 1, 2]])")
      .def(py::init([](const py::object& vertices, const py::object& triangles, const Arg<std::string>& name,
                       const Arg<std::string>& solid) { return meshFrom(vertices, triangles, name, solid); }),
           py::arg("vertices"), py::arg("triangles"), py::arg("name") = "a mesh", py::arg("solid") = "auto")
      .def_static(
          "from_file",
          [](const py::object& path, const py::object& scale, const Arg<std::string>& solid)
          { return meshFromFile(path, scale, solid); },
          py::arg("path"), py::arg("scale") = 1.0, py::arg("solid") = "auto",
          "Reads an STL, DAE, OBJ or PLY file. scale: a factor, or three factors for x, y and z; negative factors "
          "mirror the mesh.\n\nRaises Error if the file cannot be read or has no triangles.\n\n"
          "    gps.Mesh.from_file(\"part.stl\", scale=0.001)")
      .def_readonly("name", &Mesh::name, "The origin of the mesh.")
      .def_property_readonly(
          "solid", [](const Mesh& mesh) { return core::toString(mesh.solid); }, "auto, surface or filled.")
      .def_property_readonly(
          "vertices",
          [](const py::object& self)
          {
            const auto& mesh = self.cast<const Mesh&>();
            py::array view = viewOf(mesh.vertices.front().data(), {static_cast<py::ssize_t>(mesh.vertices.size()), 3},
                                    {sizeof(Eigen::Vector3d), sizeof(double)}, self);
            view.attr("setflags")(py::arg("write") = false);
            return view;
          },
          "Metres, shape (v, 3). A view that cannot be written.")
      .def_property_readonly(
          "triangles",
          [](const py::object& self)
          {
            const auto& mesh = self.cast<const Mesh&>();
            py::array view = viewOf(mesh.triangles.front().data(), {static_cast<py::ssize_t>(mesh.triangles.size()), 3},
                                    {3 * sizeof(std::uint32_t), sizeof(std::uint32_t)}, self);
            view.attr("setflags")(py::arg("write") = false);
            return view;
          },
          "Indices of vertices, shape (t, 3). A view that cannot be written.");
}
}  // namespace gpu_planning_scene::python
