#pragma once

#include <memory>

#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
std::unique_ptr<Method> makeBreadthFirst(const Mesh& a, const Mesh& b);
}  // namespace gpu_planning_scene::core::literature
