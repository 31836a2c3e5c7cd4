// One lane per item whose state is still open after the traversal: whether one shape has a component inside the other, a
// mesh with closed components, though no surfaces cross.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#include "items.glsl"
#include "boxes.glsl"
#include "error_bounds.glsl"
#include "instances.glsl"
#include "counters.glsl"
#include "verdicts.glsl"
#include "components.glsl"
#include "triangles.glsl"
#include "winding_number.glsl"
layout(location = 2) uniform uint item_capacity;

// STATE_* bits for the components of `inner`, placed by `pose` in the solid's frame.
uint meshContainment(Instance inner, Instance solid, Pose pose, float error, inout uint iterations)
{
  if (solid.kind != SOLID_MESH)
    return 0u;
  if (inner.component_count == 0u)
    return STATE_UNDECIDED;
  const Box bounds = fetchNode(solid.root).box;
  const float diagonal = 2.0 * length(bounds.extent) * (1.0 + 8.0 * u);
  uint found = 0u;
  uint i = 0u;
  for (; i < inner.component_count && iterations > 0u; ++i, --iterations)
  {
    // What is inside is no longer than the solid's box from corner to corner, and all its points are in that box.
    const uint component = inner.first_component + i;
    const vec3 point = apply(pose, componentPoint(component));
    if (componentSize(component) > diagonal || any(greaterThan(abs(point - bounds.center) - bounds.extent, vec3(error))))
      continue;
    found |= insideMesh(solid.root, point, error, iterations);
  }
  // Components that were not looked at, whoever ended the loop, are not known to be outside.
  return i < inner.component_count ? found | STATE_UNDECIDED : found;
}

void main()
{
  const uint i = invocationIndex();
  if (i >= min(counters[COUNTER_ITEMS], item_capacity))
    return;
  const Item item = fetchItem(i);
  if (isDecided(item.state))
    return;
  const Instance a = fetchInstance(pairOther(item.pair));
  const Instance b = fetchInstance(pairRobot(item.pair));
  uint iterations = LANE_ITERATIONS / (4u * LEAF_TRIANGLES);  // of loops that have short ones within
  uint found = meshContainment(b, a, item.pose, boxError(item.error), iterations);
  if ((found & STATE_HIT) == 0u)
    found |= meshContainment(a, b, inversePose(item.pose), inverseError(item.error, farCorner(fetchNode(a.root).box)), iterations);
  if (found != 0u)
    report(item.state, item.pair, found);
}
