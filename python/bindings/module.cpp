#include <exception>

#include "base/text/utf8.h"
#include "bindings/bindings.h"
#include "gpu_planning_scene/error.h"

// The extension module of the Python package gpu_planning_scene.
namespace gpu_planning_scene::python
{
namespace
{
void addErrors(pybind11::module_& module)
{
  auto& error = pybind11::register_exception<core::Error>(module, "Error", PyExc_RuntimeError);
  error.doc() =
      "A wrong input, or a device that cannot be used. The text is one line: the fault, its place, and the remedy. A "
      "call that raises an Error has changed nothing. This does not hold for DeviceLost.";
  auto& lost = pybind11::register_exception<core::DeviceLost>(module, "DeviceLost", error);
  lost.doc() =
      "The device or its context is lost, or it failed in a way that no input causes. The object that raised this "
      "error is no longer usable: create a new one.";
  for (pybind11::object exception : {pybind11::object(error), pybind11::object(lost)})
    exception.attr("__module__") = "gpu_planning_scene";
  // Python would drop a message that is not UTF-8, for example because of the name of a file. pybind11 passes what this
  // translator throws to the other ones.
  pybind11::register_exception_translator(
      [](std::exception_ptr exception)
      {
        try
        {
          std::rethrow_exception(exception);
        }
        catch (const core::DeviceLost& fault)
        {
          throw core::DeviceLost(core::inUtf8(fault.what()));
        }
        catch (const core::Error& fault)
        {
          throw core::Error(core::inUtf8(fault.what()));
        }
      });
}
}  // namespace
}  // namespace gpu_planning_scene::python

PYBIND11_MODULE(_core, module)
{
  using namespace gpu_planning_scene::python;
  addErrors(module);
  addShapes(module);
  addRobotModel(module);
  addAllowedCollisionMatrix(module);
  addPlanningScene(module);
  addSceneReport(module);
  addStateChecker(module);
  addMotionChecker(module);
  addStateInspector(module);
  addKinematicConstraints(module);
  addPlanning(module);
  addCartesianPath(module);
  addPathTiming(module);
  addInverseKinematics(module);
  addRender(module);
}
