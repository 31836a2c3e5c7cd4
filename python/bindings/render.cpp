#include <algorithm>
#include <memory>
#include <vector>

#include "bindings/arguments.h"
#include "bindings/bindings.h"
#include "gpu_planning_scene/error.h"
#include "gpu_planning_scene/state_inspector.h"
#include "render/renderer.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::Camera;
using core::Image;
using core::PlanningScene;

constexpr std::size_t kMaxContacts = 200;
constexpr std::size_t kMaxContactsOfPair = 5;

/// The picture of the tool `render`: colliding bodies are red, contact points yellow.
Image picture(const std::shared_ptr<const PlanningScene>& scene, const std::vector<double>& state,
              const Eigen::Vector3d& up, const Eigen::Vector3d* eye, const Eigen::Vector3d* target, int width,
              int height, const std::string& device)
{
  const auto colliding = core::collidingPairs(*scene, state.data());
  std::vector<Eigen::Vector3d> points;
  if (!colliding.empty())
    for (const core::Contact& contact :
         core::StateInspector(scene).contacts(state.data(), "", kMaxContacts, kMaxContactsOfPair))
      points.push_back(contact.point);
  Camera camera = eye == nullptr ? core::clearestView(*scene, state.data(), colliding, points, up, device)
                                 : core::viewsOf(*scene, state.data(), up).front();
  if (eye != nullptr)
    camera.eye = *eye;
  if (target != nullptr)
    camera.target = *target;
  return core::render(*scene, state.data(), colliding, points, camera, width, height, device);
}

py::array_t<std::uint8_t> render(const Arg<std::shared_ptr<PlanningScene>>& scene, const py::object& state,
                                 Arg<std::size_t> width, Arg<std::size_t> height, const py::object& eye,
                                 const py::object& target, const py::object& up, const Arg<std::string>& device)
{
  constexpr std::size_t kLargest = 1 << 20;  // the library names a smaller limit of the device
  const auto copy = std::make_shared<const PlanningScene>(*scene.value);
  std::vector<double> row = copy->current_state;
  if (!state.is_none())
    row = rowFrom(state, *copy->robot, "state", &copy->current_state);
  if (row.empty())
    row = copy->robot->defaultState();
  const Eigen::Vector3d upward = vectorFrom(up, "up");
  if (!(upward.norm() > 0.0))
    throw core::Error("up: the vector has length 0");
  const Eigen::Vector3d from = eye.is_none() ? Eigen::Vector3d::Zero() : vectorFrom(eye, "eye");
  const Eigen::Vector3d at = target.is_none() ? Eigen::Vector3d::Zero() : vectorFrom(target, "target");
  const auto image = std::make_unique<Image>(withoutLock(
      [&]
      {
        return picture(copy, row, upward.normalized(), eye.is_none() ? nullptr : &from,
                       target.is_none() ? nullptr : &at, static_cast<int>(std::min(width.value, kLargest)),
                       static_cast<int>(std::min(height.value, kLargest)), device.value);
      }));
  return py::array_t<std::uint8_t>({image->height, image->width, 3}, image->rgb.data());
}
}  // namespace

void addRender(py::module_& module)
{
  module.def(
      "render", &render, py::arg("scene"), py::arg("state") = py::none(), py::arg("width") = 960,
      py::arg("height") = 720, py::arg("eye") = py::none(), py::arg("target") = py::none(),
      py::arg("up") = py::make_tuple(0.0, 0.0, 1.0), py::arg("device") = "auto",
      "Draws the collision shapes of a scene with OpenGL, without a window: links grey, objects in colours, "
      "bodies that collide red, contact points yellow.\n\nstate: shape (variables,), or the name of a state; "
      "None: the current state of "
      "the scene, or the default state of the robot. width, height: pixels. eye, target: of the camera, in metres in "
      "the planning frame; without an eye, the view is chosen so that few parts of links and contacts are hidden. up: "
      "the upward "
      "direction. device: as in StateChecker, but a single OpenGL device.\n\nReturns an array of shape (height, width, "
      "3), "
      "uint8, red, green and blue, rows from the top. Raises Error if the size, the camera or the device cannot "
      "be used.\n\n    matplotlib.pyplot.imsave(\"scene.png\", gps.render(scene))");
}
}  // namespace gpu_planning_scene::python
