// Broad phase among links: one lane per (state, robot instance) compares its sphere with those of its partners.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#include "geometries.glsl"
#include "candidates.glsl"
layout(std430, binding = BINDING_A) readonly buffer Spheres { vec4 spheres[]; };
layout(std430, binding = BINDING_C) readonly buffer Partners { uint partners[]; };  // robot_count + 1 offsets, then instances

void main()
{
  const uint i = invocationIndex();
  if (i >= state_count * robot_count)
    return;
  const uint state = stateOf(i);
  const uint robot = robotOf(i);
  const vec4 mine = spheres[i];
  const uint end = partners[robot + 1u];
  for (uint k = partners[robot]; k < end; ++k)
  {
    const uint other = partners[robot_count + 1u + k];
    const vec4 theirs = spheres[other * state_count + state];
    const vec3 apart = mine.xyz - theirs.xyz;
    const float reach = mine.w + theirs.w;
    if (!(dot(apart, apart) > reach * reach))
      addCandidate(state, packPair(robot, other));
  }
}
