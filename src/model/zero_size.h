#pragma once

#include "gpu_planning_scene/shapes.h"

namespace gpu_planning_scene::core
{
/// What the sizes of a primitive that are 0 make of it.
enum class ZeroSize
{
  None,   ///< no size is 0, or it is no primitive
  Flat,   ///< a rectangle, a disc or a line
  Point,  ///< all sizes are 0
};

/// Finds sizes of 0. A flat primitive gets 1e-9 m in place of 0, because it still can collide: this is the width of the
/// band in which a verdict may be either (README). A point is not changed; robots have them in place of "no shape".
ZeroSize thicken(Shape& shape);
}  // namespace gpu_planning_scene::core
