#include "gpu_planning_scene/planning_scene.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include <pybind11/stl.h>

#include "bindings/arguments.h"
#include "bindings/bindings.h"
#include "bindings/shapes.h"
#include "gpu_planning_scene/body_parts.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/octomap.h"
#include "scene/has_body.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::AttachedObject;
using core::Error;
using core::PlanningScene;
using core::WorldObject;
using Name = Arg<std::string>;
using RobotPtr = std::shared_ptr<core::RobotModel>;

WorldObject& objectOf(PlanningScene& scene, const std::string& id)
{
  for (WorldObject& object : scene.objects)
    if (object.id == id)
      return object;
  throw Error("the scene has no object '" + id + "' in the world");
}

py::list openParts(const PlanningScene& scene)
{
  const std::vector<core::BodyPart> parts = withoutLock([&] { return core::openParts(scene); });
  py::list list;
  for (const core::BodyPart& entry : parts)
  {
    py::dict part;
    part["body"] = scene.bodyName(entry.body);
    part["mesh"] = entry.mesh;
    part["kind"] = entry.part.kind == core::PartKind::Surface  ? "surface"
                   : entry.part.kind == core::PartKind::Filled ? "filled"
                                                               : "mended";
    part["triangles"] = entry.part.triangles;
    part["holes"] = entry.part.holes;
    part["largest_hole"] = entry.part.largest_hole;
    part["hole_share"] = entry.part.hole_share;
    list.append(part);
  }
  return list;
}

double validPadding(double padding, const std::string& body)
{
  if (!(padding >= 0.0 && padding <= core::kLargestLength))
    throw Error("the padding of '" + body + "' is " + std::to_string(padding) +
                " m; it must be at least 0 and at most 1e6");
  return padding;
}

void addObject(PlanningScene& scene, const Name& id, const py::object& shapes, const py::object& pose,
               Arg<double> padding)
{
  const std::string where = "object '" + id.value + "'";
  if (id.value.empty())
    throw Error("an object needs an id that is not empty");
  if (id.value == core::kOctomapId)
    throw Error(where + " cannot be added: the id is kept for octomaps");
  if (core::hasBody(scene, id.value))
    throw Error(where + " cannot be added: the scene has a link or an object of this name");
  WorldObject object;
  object.id = id.value;
  object.pose = poseFrom(pose, where);
  object.shapes = shapesFrom(shapes, where);
  if (object.shapes.empty())
    throw Error(where + " has no shapes");
  object.padding = validPadding(padding.value, id.value);
  scene.objects.push_back(std::move(object));
}

void removeObject(PlanningScene& scene, const Name& id)
{
  objectOf(scene, id.value);
  const auto has_id = [&](const WorldObject& object) { return object.id == id.value; };
  scene.objects.erase(std::find_if(scene.objects.begin(), scene.objects.end(), has_id));
  scene.allowed_collisions.removeEntry(id.value);
}

/// The padding of a body, which may be a link whose padding was never set.
double* paddingOf(PlanningScene& scene, const std::string& body)
{
  if (const int link = scene.robot->linkIndex(body); link >= 0)
  {
    if (scene.link_padding.empty())
      scene.link_padding.resize(scene.robot->links().size(), 0.0);
    return &scene.link_padding[static_cast<std::size_t>(link)];
  }
  for (AttachedObject& object : scene.attached)
    if (object.object.id == body)
      return &object.padding;
  for (WorldObject& object : scene.objects)
    if (object.id == body)
      return &object.padding;
  throw Error("the scene has no link or object '" + body + "'");
}

/// The values of an argument `state`, or, if it is None, of the scene's current state.
std::vector<double> stateOr(const PlanningScene& scene, py::handle state)
{
  return state.is_none() ? scene.current_state : rowFrom(state, *scene.robot, "state", &scene.current_state);
}

std::vector<double> requiredState(const PlanningScene& scene, py::handle state)
{
  if (state.is_none() && scene.current_state.empty())
    throw Error("the scene has no current_state; set it, or give the argument state");
  return stateOr(scene, state);
}

template <typename Load>
std::shared_ptr<PlanningScene> loadedScene(const Load& load)
{
  std::vector<std::string> warnings;
  auto scene = withoutLock([&] { return std::make_shared<PlanningScene>(load(&warnings)); });
  warnOf(warnings);
  return scene;
}

std::shared_ptr<PlanningScene> loadSceneFile(const py::object& path, const Arg<RobotPtr>& robot,
                                             const py::object& packages, const py::object& files)
{
  const core::PackageResolver resolver = packagesFrom(packages);
  const core::MeshAccess meshes = meshesFrom(files);
  const std::string file = pathFrom(path, "path");
  return loadedScene([&](auto* warnings)
                     { return core::loadSceneFile(file, robot.value, resolver, warnings, meshes); });
}

std::shared_ptr<PlanningScene> loadSceneText(const Name& text, const Arg<RobotPtr>& robot, const py::object& packages,
                                             const py::object& folder, const Name& name, const py::object& files)
{
  const core::PackageResolver resolver = packagesFrom(packages);
  const core::MeshAccess meshes = meshesFrom(files);
  const std::string start = pathFrom(folder, "folder");
  return loadedScene(
      [&](auto* warnings)
      { return core::loadSceneText(text.value, name.value, start, robot.value, resolver, warnings, meshes); });
}

std::string resolveUri(const Name& uri, const py::object& folder, const py::object& packages)
{
  const core::PackageResolver resolver = packagesFrom(packages);
  const std::string start = pathFrom(folder, "folder");
  return withoutLock([&] { return core::resolveUri(uri.value, start, resolver); });
}

std::size_t bodyCount(const PlanningScene& scene)
{
  return scene.robot->links().size() + scene.objects.size() + scene.attached.size();
}

std::string bodyName(const PlanningScene& scene, Arg<std::int64_t> index)
{
  const std::int64_t body = index.value;
  if (body < 0 || body >= static_cast<std::int64_t>(bodyCount(scene)))
    throw Error("there is no body " + std::to_string(body) + "; the scene has " + std::to_string(bodyCount(scene)) +
                " bodies");
  return scene.bodyName(static_cast<int>(body));
}

void addObjects(py::module_& module)
{
  py::class_<WorldObject>(module, "WorldObject", "An object of the world, as it was when it was asked for.")
      .def_readonly("id", &WorldObject::id)
      .def_property_readonly(
          "pose", [](const WorldObject& object) { return toPython(object.pose); },
          "In the planning frame, or, for an attached object, in the link's frame; shape (4, 4).")
      .def_property_readonly(
          "shapes", [](const WorldObject& object) { return toPython(object.shapes); },
          "Pairs (shape, pose in the object's frame).")
      .def_readonly("padding", &WorldObject::padding, "Metres.");
  py::class_<AttachedObject>(module, "AttachedObject", "An object that a link carries.")
      .def_readonly("object", &AttachedObject::object)
      .def_readonly("link", &AttachedObject::link, "The index of the link.")
      .def_readonly("touch_links", &AttachedObject::touch_links, "Indices of links that may touch the object.")
      .def_readonly("padding", &AttachedObject::padding, "Metres, added to the padding of the link.");
}

void addChanges(py::class_<PlanningScene, std::shared_ptr<PlanningScene>>& scene)
{
  scene
      .def("add_object", &addObject, py::arg("id"), py::arg("shapes"), py::arg("pose") = py::none(),
           py::arg("padding") = 0.0,
           "Adds an object to the world.\n\nshapes: a shape, a pair (shape, pose in the object's frame), or a list of "
           "both. pose: in the planning frame: a matrix (4, 4), three numbers x y z, seven numbers x y z qx qy qz qw, "
           "or a pair (xyz, xyzw); None: the identity. padding: metres.\n\nRaises Error if the name is taken, or if a "
           "shape, a pose or the padding is not valid.\n\n"
           "    scene.add_object(\"box\", gps.Box([0.4, 0.2, 0.4]), pose=[0.9, -0.3, 0.0])")
      .def("remove_object", &removeObject, py::arg("id"),
           "Removes an object of the world and its entries in the allowed collision matrix. Raises Error for an "
           "unknown object.")
      .def(
          "move_object",
          [](PlanningScene& self, const Name& id, const py::object& pose)
          { objectOf(self, id.value).pose = poseFrom(pose, "object '" + id.value + "'"); },
          py::arg("id"), py::arg("pose"), "Gives an object of the world a new pose, as in add_object.")
      .def(
          "attach",
          [](PlanningScene& self, const Name& object, const Name& link,
             const Arg<std::vector<std::string>>& touch_links, const py::object& state)
          { self.attach(object.value, link.value, touch_links.value, requiredState(self, state).data()); },
          py::arg("object"), py::arg("link"), py::arg("touch_links") = std::vector<std::string>(),
          py::arg("state") = py::none(),
          "Attaches an object of the world to a link. The object stays where it is in `state`.\n\ntouch_links: names "
          "of other links that may touch it. state: shape (variables,), or the name of a state; None: the current "
          "state. Raises Error for an "
          "unknown object or link, for a half-space, and without a state.\n\n"
          "    scene.attach(\"can\", \"palm\", touch_links=[\"finger\"], state=robot.default_state())")
      .def(
          "detach",
          [](PlanningScene& self, const Name& object, const py::object& state)
          { self.detach(object.value, requiredState(self, state).data()); },
          py::arg("object"), py::arg("state") = py::none(),
          "Returns an attached object to the world, at its place in `state`. Raises Error if no link carries it, and "
          "without a state.")
      .def(
          "padding", [](PlanningScene& self, const Name& body) { return *paddingOf(self, body.value); },
          py::arg("body"),
          "The padding of a link or an object in metres; of an attached object, without the padding of its link. "
          "Raises "
          "Error for an unknown body.")
      .def(
          "set_padding",
          [](PlanningScene& self, const Name& body, Arg<double> padding)
          { *paddingOf(self, body.value) = validPadding(padding.value, body.value); },
          py::arg("body"), py::arg("padding"),
          "Sets the padding of a link or an object in metres, at least 0. A link and an object of the world collide "
          "if their distance is at most the sum of their paddings. The padding of an attached object is its own plus "
          "that of its link. Raises Error for an unknown body and for a negative value.\n\n"
          "    scene.set_padding(\"forearm\", 0.02)");
}
}  // namespace

void addPlanningScene(py::module_& module)
{
  addObjects(module);
  py::class_<PlanningScene, std::shared_ptr<PlanningScene>> scene(
      module, "PlanningScene",
      "A robot, the objects around it, the allowed collision matrix, and the current state. It is a value: a checker "
      "takes a copy, and later changes of the scene do not change the checker (see StateChecker.set_scene). Copies "
      "share meshes. A body is a link, an object of the world or an attached object. Body indices count them in this "
      "order.\n\n    scene = gps.PlanningScene(robot)\n    scene.add_object(\"ball\", gps.Sphere(0.1), [0.6, 0.4, "
      "0.5])");
  scene
      .def(py::init([](const Arg<RobotPtr>& robot) { return std::make_shared<PlanningScene>(robot.value); }),
           py::arg("robot"), "A scene without objects, with the allowed collisions of the robot.")
      .def_readwrite("name", &PlanningScene::name)
      .def_property_readonly(
          "robot", [](const PlanningScene& self) { return std::const_pointer_cast<core::RobotModel>(self.robot); })
      .def_readwrite("revision", &PlanningScene::revision, "A number of the caller's; a BatchResult repeats it.")
      .def_property_readonly(
          "objects", [](const PlanningScene& self) { return self.objects; }, "Copies of the objects of the world.")
      .def_property_readonly(
          "attached", [](const PlanningScene& self) { return self.attached; }, "Copies of the attached objects.")
      .def_readwrite("allowed_collisions", &PlanningScene::allowed_collisions,
                     "The AllowedCollisionMatrix of this scene; changes of it change the scene.")
      .def_property(
          "current_state",
          [](const PlanningScene& self) -> py::object
          {
            if (self.current_state.empty())
              return py::none();
            return py::array_t<double>(static_cast<py::ssize_t>(self.current_state.size()), self.current_state.data());
          },
          [](PlanningScene& self, const py::object& state)
          {
            self.current_state = state.is_none() ? std::vector<double>()
                                                 : rowFrom(state, *self.robot, "current_state", &self.current_state);
          },
          "A copy of the state of the robot, shape (variables,), or None. It can be set to the name of a state of the "
          "SRDF: variables that this state does not set keep their values.")
      .def("body_name", &bodyName, py::arg("body"), "The name of the body with this index.")
      .def_property_readonly(
          "body_names",
          [](const PlanningScene& self)
          {
            std::vector<std::string> names;
            for (std::size_t body = 0; body < bodyCount(self); ++body)
              names.push_back(self.bodyName(static_cast<int>(body)));
            return names;
          },
          "The names of all bodies, by body index.")
      .def("open_parts", &openParts,
           "The parts of meshes that were not closed in their files: a list of dicts with body (its name), mesh, kind "
           "(mended, filled, or surface: a body inside it does not collide), triangles, holes, largest_hole (metres) "
           "and "
           "hole_share (of the part's area).")
      .def(
          "frame",
          [](const PlanningScene& self, const Name& name, const py::object& state)
          {
            const std::vector<double> row = stateOr(self, state);
            const auto pose = self.frame(name.value, row.empty() ? nullptr : row.data());
            if (!pose)
              throw Error("the scene has no frame '" + name.value + "'");
            return toPython(*pose);
          },
          py::arg("name"), py::arg("state") = py::none(),
          "The pose of a link, an object, a subframe (OBJECT/SUBFRAME) or a fixed frame in the planning frame, shape "
          "(4, 4). Raises Error for an unknown frame, and if a link's pose is needed and there is no state.")
      .def(
          "copy", [](const PlanningScene& self) { return std::make_shared<PlanningScene>(self); },
          "An independent copy, which shares the meshes.")
      .def("__copy__", [](const PlanningScene& self) { return std::make_shared<PlanningScene>(self); })
      .def("__repr__",
           [](const PlanningScene& self)
           {
             return "<PlanningScene of robot '" + self.robot->name() + "': " + std::to_string(self.objects.size()) +
                    " objects, " + std::to_string(self.attached.size()) + " attached>";
           });
  addChanges(scene);
  module.def(
      "load_scene_file", &loadSceneFile, py::arg("path"), py::arg("robot"), py::arg("packages") = py::none(),
      py::arg("files") = py::none(),
      "Loads a scene file (docs/scene_files.md).\n\npackages, files: as in RobotModel.from_files. Entries that are not "
      "used are Python warnings. Raises Error with file and line.\n\n"
      "    scene = gps.load_scene_file(\"scene.yaml\", robot)");
  module.def("load_scene_text", &loadSceneText, py::arg("text"), py::arg("robot"), py::arg("packages") = py::none(),
             py::arg("folder") = ".", py::arg("name") = "the text of the scene", py::arg("files") = py::none(),
             "Loads the text of a scene file.\n\nname: takes the place of the path in messages; a name that ends in "
             ".scene means the text format of RViz. folder: the start of relative paths of meshes. Everything else is "
             "as in load_scene_file.\n\n"
             "    scene = gps.load_scene_text(\"world: {collision_objects: []}\", robot)");
  module.def("resolve_uri", &resolveUri, py::arg("uri"), py::arg("folder") = py::none(),
             py::arg("packages") = py::none(),
             "The path of a mesh or octomap file.\n\nuri: package://NAME/PATH, file:///PATH, an absolute path, or a "
             "path relative to `folder`. packages: as in RobotModel.from_files. The file need not exist. Raises Error "
             "for another URI and for an unknown package.\n\n"
             "    gps.resolve_uri(\"package://ur5/meshes/base.stl\", packages={\"ur5\": \"/path/ur5\"})");
}
}  // namespace gpu_planning_scene::python
