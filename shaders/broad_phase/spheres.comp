// One invocation per (state, robot instance): writes the sphere around its root box, for the broad phase among links.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "problem/instance_lists.glsl"
#include "geometry/pose.glsl"
#include "problem/nodes.glsl"
#include "broad_phase/placed_instance.glsl"
// xyz: the centre, relative to the scene's origin; w: the radius; metres.
layout(std430, binding = BINDING_A) writeonly buffer Spheres { vec4 spheres[]; };

void main()
{
  const uint i = invocationIndex();
  if (i >= state_count * robot_count)
    return;
  const PlacedInstance placed = place(rowOf(i), stateOf(i));
  spheres[i] = vec4(placed.center, length(placed.box.extent) + placed.world_margin + placed.margin);
}
