#pragma once

#include <pybind11/pybind11.h>

// Each function adds the classes of one subject to the module. The order of the calls matters: a function may name
// only classes that were added before.
namespace gpu_planning_scene::python
{
void addShapes(pybind11::module_& module);
void addRobotModel(pybind11::module_& module);
void addAllowedCollisionMatrix(pybind11::module_& module);
void addPlanningScene(pybind11::module_& module);
void addSceneReport(pybind11::module_& module);
void addStateChecker(pybind11::module_& module);
void addMotionChecker(pybind11::module_& module);
void addStateInspector(pybind11::module_& module);
void addKinematicConstraints(pybind11::module_& module);
void addPlanning(pybind11::module_& module);
void addCartesianPath(pybind11::module_& module);
void addPathTiming(pybind11::module_& module);
void addInverseKinematics(pybind11::module_& module);
void addRender(pybind11::module_& module);
}  // namespace gpu_planning_scene::python
