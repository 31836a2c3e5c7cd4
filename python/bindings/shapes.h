#pragma once

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::python
{
/// A shape, a pair (shape, pose), or a list of shapes and pairs. Throws Error that begins with `where` if one is not
/// valid.
std::vector<core::PlacedShape> shapesFrom(pybind11::handle object, const std::string& where);

pybind11::object toPython(const core::Shape& shape);

/// A list of pairs (shape, pose).
pybind11::list toPython(const std::vector<core::PlacedShape>& shapes);
}  // namespace gpu_planning_scene::python
