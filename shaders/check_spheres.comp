// One lane per (state, robot instance): the sphere around its root box in the planning frame, for the broad phase among links.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#include "geometries.glsl"
#include "pose.glsl"
#include "boxes.glsl"
#include "broad_phase.glsl"
layout(std430, binding = BINDING_A) writeonly buffer Spheres { vec4 spheres[]; };  // centre and radius

void main()
{
  const uint i = invocationIndex();
  if (i >= state_count * robot_count)
    return;
  const PlacedInstance placed = place(rowOf(i), stateOf(i));
  spheres[i] = vec4(placed.center, length(placed.box.extent) + placed.way + placed.margin);
}
