#pragma once

#include <optional>

#include "stability/case.h"

namespace gpu_planning_scene::core::stability
{
/// FCL: meshes as BVHModel<OBBRSS>, primitives as FCL's own. A required distance above 0 is tested with FCL's distance
/// query. `own_narrow_phase`: FCL's own GJK solver for convex shapes instead of libccd, the default. Returns no value
/// for distances to half-spaces, because FCL has no such query.
std::optional<bool> fclCollides(const Case& c, bool own_narrow_phase);

/// Tests each pair of triangles with the separating axis test in float32, without error bounds. This is a common form
/// of a GPU check. Surfaces only.
bool floatCollides(const Case& c);

/// Bullet in single precision, its common build: meshes as convex hulls, primitives as Bullet's own. A contact at a
/// distance of at most the required distance is a collision.
bool bulletCollides(const Case& c);
}  // namespace gpu_planning_scene::core::stability
