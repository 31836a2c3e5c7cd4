#pragma once

#include <cstddef>
#include <string>

#include "gpu_planning_scene/planning_scene.h"

namespace gpu_planning_scene::core
{
/// Pairs of bodies that a scene no longer checks.
struct NewlyAllowed
{
  std::size_t pairs = 0;
  std::string body_1, body_2;  ///< the first of the pairs; empty if there is none
};

/// The pairs of bodies of `scene` with a link that its matrix allows and `before` does not allow. These pairs
/// do not count: pairs with a link without shapes, pairs of an attached object with its link or a touch link, and pairs
/// of two objects, because a robot's own matrix does not name objects.
NewlyAllowed findNewlyAllowed(const PlanningScene& scene, const AllowedCollisionMatrix& before);
}  // namespace gpu_planning_scene::core
