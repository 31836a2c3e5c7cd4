#include "bindings/state_checker.h"

#include <algorithm>
#include <utility>

#include <pybind11/stl.h>

#include "bindings/arguments.h"
#include "bindings/bindings.h"
#include "bindings/interrupt.h"
#include "bindings/named_rows.h"
#include "collision/checkers/open_checker.h"
#include "gpu_planning_scene/batch_checker.h"
#include "gpu_planning_scene/cpu_checker.h"
#include "gpu_planning_scene/device.h"
#include "gpu_planning_scene/error.h"

namespace gpu_planning_scene::python
{
namespace
{
using core::BatchCheckerOptions;
using core::BatchResult;
using core::Device;
using core::PlanningScene;
using core::StateChecker;
using ScenePtr = std::shared_ptr<PlanningScene>;

/// `open` makes a checker of a scene. The checker gets a copy, which no later change of the caller's scene changes.
template <typename Open>
CheckerPtr opened(const PlanningScene& scene, const Open& open)
{
  const auto copy = std::make_shared<const PlanningScene>(scene);
  return withoutLock([&] { return std::make_shared<SharedChecker>(open(copy), copy); });
}

BatchCheckerOptions optionsFrom(const Arg<std::string>& device, Arg<std::size_t> max_batch, Arg<bool> device_only,
                                const Arg<std::string>& traversal)
{
  BatchCheckerOptions options;
  options.device = device.value;
  options.max_batch = max_batch.value;
  options.device_only = device_only.value;
  options.traversal = core::traversalFromName(traversal.value);
  return options;
}

/// A warning of Python, from code that runs without the interpreter's lock. If a filter makes an error of it, Python
/// prints this error: an exception here would leave a changed scene behind.
void warnWithLock(const std::string& line)
{
  const py::gil_scoped_acquire acquired;
  if (PyErr_WarnEx(PyExc_UserWarning, line.c_str(), 1) != 0)
    PyErr_WriteUnraisable(nullptr);
}

CheckerPtr openedOnDevice(const Arg<ScenePtr>& scene, const Arg<std::string>& device, Arg<std::size_t> max_batch,
                          Arg<bool> device_only, const Arg<std::string>& traversal)
{
  const BatchCheckerOptions options = optionsFrom(device, max_batch, device_only, traversal);
  return opened(*scene.value,
                [&](const std::shared_ptr<const PlanningScene>& copy) -> std::shared_ptr<StateChecker>
                { return core::openChecker(copy, options, warnWithLock); });
}

BatchResult checkStates(SharedChecker& checker, const py::object& states, const Arg<std::string>& group)
{
  const auto scene = checker.scene();
  const Rows rows = rowsFrom(states, *scene->robot, "states", &scene->current_state);
  requireNamesOfGroup(namesFrom(states), *scene->robot, group.value, "states");
  const double* data = rows.data();
  Interrupt interrupt;
  BatchResult result = withoutLock([&] { return checker.check(data, rows.count, group.value, interrupt); });
  interrupt.rethrow();
  warnOfValuesOutsideLimits(rows, *scene->robot, "states");
  return result;
}

void addDevice(py::module_& module)
{
  py::class_<Device>(module, "Device", "An EGL device that supports an OpenGL 4.5 context without a window.")
      .def_readonly("index", &Device::index, "str(index) selects the device.")
      .def_readonly("renderer", &Device::renderer)
      .def_readonly("version", &Device::version)
      .def_readonly("software", &Device::software, "True for llvmpipe and other software renderers.")
      .def(
          "__repr__", [](const Device& device)
          { return "<Device " + std::to_string(device.index) + ": " + device.renderer + ">"; });
  module.def(
      "list_devices", [] { return withoutLock([] { return core::listDevices(); }); },
      "All usable devices. To test a device, the function creates and destroys a context on it. Raises Error if the "
      "EGL or OpenGL library is missing.\n\n    for device in gps.list_devices():\n        print(device)");
}

void addBatchResult(py::module_& module)
{
  py::class_<BatchResult>(module, "BatchResult",
                          "The answers of StateChecker.check. The arrays are views of its memory.")
      .def_property_readonly(
          "valid",
          [](const py::object& self)
          {
            const auto& valid = self.cast<const BatchResult&>().valid;
            static_assert(sizeof(bool) == 1);
            return viewOf(reinterpret_cast<const bool*>(valid.data()), {static_cast<py::ssize_t>(valid.size())}, {1},
                          self);
          },
          "True: the state is free of collision. Shape (n,), bool.")
      .def_property_readonly(
          "colliding",
          [](const py::object& self)
          {
            const auto& pairs = self.cast<const BatchResult&>().colliding;
            return viewOf(reinterpret_cast<const std::int32_t*>(pairs.data()),
                          {static_cast<py::ssize_t>(pairs.size()), 2}, {8, 4}, self);
          },
          "The body indices of a colliding pair, ascending; -1, -1 for a free state. Shape (n, 2), int32. Of several "
          "colliding pairs, any one may be reported.")
      .def_readonly("revision", &BatchResult::revision, "PlanningScene.revision of the checked scene.")
      .def_readonly("seconds", &BatchResult::seconds, "Wall time of the check, without the time of Python.")
      .def_readonly("device_states", &BatchResult::device_states,
                    "Number of states that devices decided. The CPU decided the others.")
      .def_readonly("undecided_states", &BatchResult::undecided_states,
                    "Number of states that a device left undecided and the CPU then decided.")
      .def(
          "__len__", [](const BatchResult& result) { return result.valid.size(); });
}
}  // namespace

SharedChecker::SharedChecker(std::shared_ptr<StateChecker> checker, std::shared_ptr<const PlanningScene> scene)
  : checker_(std::move(checker)), scene_(std::move(scene))
{
}

std::shared_ptr<const PlanningScene> SharedChecker::scene() const
{
  const std::lock_guard<std::mutex> lock(scene_mutex_);
  return scene_;
}

SharedChecker::Call::Call(SharedChecker& checker) : shared_(checker)
{
  if (checker.caller_ == std::this_thread::get_id())
    throw core::Error(
        "the checker is in use by this thread; a signal handler cannot use the checker of the call that it "
        "interrupts");
  lock_ = std::unique_lock<std::mutex>(checker.mutex_);
  checker.caller_ = std::this_thread::get_id();
}

SharedChecker::Call::~Call()
{
  shared_.caller_ = std::thread::id();
}

void SharedChecker::setScene(std::shared_ptr<const PlanningScene> scene)
{
  const Call call(*this);
  if (scene->robot != scene_->robot)
    throw core::Error(
        "the robot of the new scene is not the RobotModel of this checker's scene; make the new scene with "
        "checker.scene.robot, or create a new checker for another robot");
  checker_->setScene(scene);
  const std::lock_guard<std::mutex> scene_lock(scene_mutex_);
  scene_ = std::move(scene);
}

core::SceneReport SharedChecker::report(const std::string& group)
{
  return checker_->report(group);
}

BatchResult SharedChecker::check(const double* states, std::size_t count, const std::string& group,
                                 Interrupt& interrupt)
{
  const Call call(*this);
  core::StateBatch batch{states, count, group};
  batch.go_on = [&interrupt](std::size_t) { return !interrupt.requested(); };
  BatchResult result;
  try
  {
    result = checker_->checkBatch(batch);
  }
  catch (const core::Cancelled&)
  {
    return {};
  }
  const std::string warning = checker_->deviceWarning();
  if (warning != known_warning_ && !warning.empty())
    warnWithLock(warning);
  known_warning_ = warning;
  return result;
}

void addStateChecker(py::module_& module)
{
  addDevice(module);
  addBatchResult(module);
  const BatchCheckerOptions defaults;
  py::class_<SharedChecker, CheckerPtr> checker(
      module, "StateChecker",
      "Checks many robot states for collision at once, on any device.\n\nscene: the checker takes a copy. "
      "device: \"cpu\" is the library's CpuChecker, which needs no OpenGL. All other values are its "
      "BatchChecker: \"auto\" takes the first GPU, or the CPU if there is none; \"software\" (llvmpipe); an "
      "index of list_devices() as a str; a part of a renderer's name; several devices as \"0+1\"; all GPUs as "
      "\"all\". All devices give the same `valid`. A device that fails is opened again; while it cannot be "
      "used, the CPU answers, and a UserWarning gives the reason. max_batch: the most states that go to a "
      "device at once. device_only: the devices check all states that they can, and \"auto\" takes llvmpipe if "
      "there is no GPU; otherwise the cores of the CPU work beside them, and check small batches alone. "
      "traversal: \"work_queue\" or \"breadth_first\".\n\n"
      "Thread-safe: calls are served one after the other, and other threads of Python run meanwhile. Raises Error if "
      "a device that `device` names cannot be used, or if the scene or an option is not valid.\n\n"
      "    checker = gps.StateChecker(scene, device=\"cpu\")\n"
      "    result = checker.check(robot.random_states(1000, seed=1))\n"
      "    print(result.valid.mean())");
  checker
      .def(py::init(&openedOnDevice), py::arg("scene"), py::arg("device") = defaults.device,
           py::arg("max_batch") = defaults.max_batch, py::arg("device_only") = defaults.device_only,
           py::arg("traversal") = "work_queue")
      .def(
          "check", &checkStates, py::arg("states"), py::arg("group") = "",
          "Checks states.\n\nstates: shape (n, variables) or (variables,), radians and metres; or a str or a list of "
          "str: "
          "names of states of the SRDF. Variables that a named state does not set have their values from the scene's "
          "current_state. A C-contiguous array "
          "of float64 is copied only for a device; it must not change during the call. group: only pairs with a link "
          "that this "
          "planning group moves are checked. Returns a BatchResult.\n\nRaises Error for another shape, an unknown "
          "group, values that are not finite or too large, and a state that the SRDF does not name. Ctrl-C ends a long "
          "call.\n\n"
          "    free = states[checker.check(states).valid]")
      .def(
          "set_scene",
          [](SharedChecker& self, const Arg<ScenePtr>& scene)
          {
            auto copy = std::make_shared<const PlanningScene>(*scene.value);
            withoutLock([&] { self.setScene(std::move(copy)); });
          },
          py::arg("scene"),
          "Replaces the scene by a copy of `scene`. Raises Error and keeps the old scene if the new one is not valid, "
          "or if "
          "its robot is not the RobotModel object checker.scene.robot.")
      .def_property_readonly(
          "scene", [](const SharedChecker& self) { return std::make_shared<PlanningScene>(*self.scene()); },
          "A copy of the scene that is checked.")
      .def(
          "report",
          [](SharedChecker& self, const Arg<std::string>& group)
          { return withoutLock([&] { return self.report(group.value); }); },
          py::arg("group") = "",
          "The pairs that are checked and left out: a SceneReport. Raises Error for an unknown "
          "group.")
      .def_property_readonly(
          "device_name", [](const SharedChecker& self) { return self.deviceName(); },
          "The name of the device: GL_RENDERER, or \"CPU\".")
      .def_property_readonly(
          "device_warning", [](const SharedChecker& self) { return self.deviceWarning(); },
          "A line if the device cannot hold the scene, or if its arithmetic breaks an assumption of the error bounds; "
          "else empty. The answers stay right, but the CPU computes more.");
}
}  // namespace gpu_planning_scene::python
