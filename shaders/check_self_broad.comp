// Broad phase among links: one lane per (state, robot instance) compares its sphere with those of its partners.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#include "geometries.glsl"
#include "candidates.glsl"
layout(binding = UNIT_SPHERES) uniform usamplerBuffer spheres;
layout(binding = UNIT_PARTNERS) uniform usamplerBuffer partners;

vec4 sphereOf(uint robot, uint state)
{
  return uintBitsToFloat(texelFetch(spheres, int(robot * state_count + state)));
}

void main()
{
  const uint i = invocationIndex();
  if (i >= state_count * robot_count)
    return;
  const uint state = stateOf(i);
  const uint robot = robotOf(i);
  const vec4 mine = sphereOf(robot, state);
  const uvec4 range = texelFetch(partners, int(robot));
  for (uint k = range.x; k < range.y; ++k)
  {
    const uvec4 four = texelFetch(partners, int(k));
    uint near = 0u;
    for (int i = 0; i < 4; ++i)
    {
      const vec4 theirs = sphereOf(min(four[i], robot_count - 1u), state);
      const vec3 apart = mine.xyz - theirs.xyz;
      const float reach = mine.w + theirs.w;
      near |= four[i] != NO_PARTNER && !(dot(apart, apart) > reach * reach) ? 1u << i : 0u;
    }
    for (; near != 0u; near &= near - 1u)
      addCandidate(state, packPair(robot, four[findLSB(near)]));
  }
}
