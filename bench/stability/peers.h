#pragma once

#include <optional>

#include "stability/case.h"

namespace gpu_planning_scene::core::stability
{
/// FCL: meshes as BVHModel<OBBRSS>, primitives as its own; a required distance above 0 by its distance query. Which of
/// its two narrow phases finds contacts of convex shapes: libccd (the default), or its own. Nothing where it has no
/// such query: distances of half-spaces.
std::optional<bool> fclCollides(const Case& c, bool own_narrow_phase);

/// Every triangle against every other by the separating-axis test in float32, without error bounds: how a check on a
/// GPU is commonly written. Surfaces only.
bool floatCollides(const Case& c);

/// Bullet (in single precision, as it is commonly built): meshes as convex hulls, primitives as its own; contacts at
/// distances up to the required one.
bool bulletCollides(const Case& c);
}  // namespace gpu_planning_scene::core::stability
