// Broad phase among links. One invocation per (state, query): compares the bounding sphere of a robot instance with the
// spheres of six others. If the spheres overlap, the pair becomes a candidate. All pairs are compared: a robot has few
// links, and this needs no tree per state.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "problem/instance_lists.glsl"
#include "broad_phase/candidates.glsl"
#include "broad_phase/queries.glsl"
#include "common/comparisons.glsl"
#include "traversal/verdicts.glsl"
layout(binding = UNIT_SPHERES) uniform usamplerBuffer spheres;

vec4 sphereOf(uint robot, uint state)
{
  return uintBitsToFloat(texelFetch(spheres, int(robot * state_count + state)));
}

uint partnerOf(uvec4 query, uint i)
{
  return query[1u + i / 2u] >> 16u * (i & 1u) & 0xffffu;
}

void main()
{
  const uint i = invocationIndex();
  if (i >= state_count * query_count)
    return;
  const uint state = stateOf(i);
  if (isDecided(state))
    return;
  const uvec4 query = fetchQuery(rowOf(i));
  const vec4 mine = sphereOf(query.x, state);
  uint near = 0u;
  for (uint k = 0u; k < QUERY_PARTNERS; ++k)
  {
    const uint partner = partnerOf(query, k);
    const vec4 theirs = sphereOf(min(partner, robot_count - 1u), state);
    precise const vec3 apart = mine.xyz - theirs.xyz;
    const float reach = mine.w + theirs.w;
    near |= partner != NO_PARTNER && !provenGreater(dot(apart, apart), reach * reach) ? 1u << k : 0u;
  }
  for (; near != 0u; near &= near - 1u)
    addCandidate(state, packPair(query.x, partnerOf(query, uint(findLSB(near)))));
}
