// Broad phase among links: one lane per (state, search), which compares the sphere of one robot instance with those of six others.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#include "geometries.glsl"
#include "candidates.glsl"
#include "searches.glsl"
#include "comparisons.glsl"
layout(binding = UNIT_SPHERES) uniform usamplerBuffer spheres;

vec4 sphereOf(uint robot, uint state)
{
  return uintBitsToFloat(texelFetch(spheres, int(robot * state_count + state)));
}

uint partnerOf(uvec4 search, uint i)
{
  return search[1u + i / 2u] >> 16u * (i & 1u) & 0xffffu;
}

void main()
{
  const uint i = invocationIndex();
  if (i >= state_count * search_count)
    return;
  const uint state = stateOf(i);
  const uvec4 search = fetchSearch(rowOf(i));
  const vec4 mine = sphereOf(search.x, state);
  uint near = 0u;
  for (uint k = 0u; k < SEARCH_PARTNERS; ++k)
  {
    const uint partner = partnerOf(search, k);
    const vec4 theirs = sphereOf(min(partner, robot_count - 1u), state);
    const vec3 apart = mine.xyz - theirs.xyz;
    const float reach = mine.w + theirs.w;
    near |= partner != NO_PARTNER && !provenGreater(dot(apart, apart), reach * reach) ? 1u << k : 0u;
  }
  for (; near != 0u; near &= near - 1u)
    addCandidate(state, packPair(search.x, partnerOf(search, uint(findLSB(near)))));
}
