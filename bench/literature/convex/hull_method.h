#pragma once

#include <memory>

#include "literature/convex/hull_tree.h"
#include "literature/method.h"

namespace gpu_planning_scene::core::literature
{
/// Two shapes collide if a hull of a leaf of one tree collides with such a hull of the other.
std::unique_ptr<Method> makeHullMethod(std::shared_ptr<const HullTree> a, std::shared_ptr<const HullTree> b);
}  // namespace gpu_planning_scene::core::literature
