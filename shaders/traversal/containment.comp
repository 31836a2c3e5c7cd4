// One invocation per root pair. It does nothing if the state of the pair has a hit already. If one shape is
// a mesh with a solid, the invocation tests whether a component of the other shape is inside this mesh
// without crossing its surface. The winding number of one point per component decides (geometry/winding_number.glsl).
// It reports the verdict.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "traversal/root_pairs.glsl"
#include "problem/nodes.glsl"
#include "geometry/error_bounds.glsl"
#include "problem/instances.glsl"
#include "common/lists.glsl"
#include "traversal/verdicts.glsl"
#include "problem/components.glsl"
#include "problem/triangles.glsl"
#include "geometry/winding_number.glsl"
layout(location = LOCATION_ROOT_PAIR_CAPACITY) uniform uint root_pair_capacity;

// Returns STATE_* bits for the components of `inner`. `pose` places them in the frame of the solid, where their points
// are off by at most `error` (metres).
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
    // A component inside the solid is at most as long as the diagonal of the solid's box, and all its points are in
    // that box.
    const uint component = inner.first_component + i;
    const vec3 point = apply(pose, componentPoint(component));
    if (componentSize(component) > diagonal ||
        any(greaterThan(abs(point - bounds.center) - bounds.extent, vec3(error))))
      continue;
    found |= insideMesh(solid.root, point, error, iterations);
  }
  // Components are left if the iterations ran out or the device ended the loop. They may be inside.
  return i < inner.component_count ? found | STATE_UNDECIDED : found;
}

void main()
{
  const uint i = invocationIndex();
  if (i >= lengthOf(LIST_ROOT_PAIRS, root_pair_capacity))
    return;
  const RootPair root_pair = fetchRootPair(i);
  if (isDecided(root_pair.state))
    return;
  const Instance a = fetchInstance(pairOther(root_pair.pair));
  const Instance b = fetchInstance(pairRobot(root_pair.pair));
  // Small, because the loops contain short inner loops.
  uint iterations = INVOCATION_ITERATIONS / (4u * LEAF_TRIANGLES);
  uint found = meshContainment(b, a, root_pair.pose, boxError(root_pair.error), iterations);
  if ((found & STATE_HIT) == 0u)
    found |= meshContainment(a, b, inversePose(root_pair.pose),
                             inverseError(root_pair.error, farCorner(fetchNode(a.root).box)), iterations);
  if (found != 0u)
    report(root_pair.state, root_pair.pair, found);
}
