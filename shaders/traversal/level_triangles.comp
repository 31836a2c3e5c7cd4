// Step 4 of a level (level.glsl). One work group per GROUP_SIZE leaf pairs: tests their triangles and reports the
// verdicts.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "traversal/root_pairs.glsl"
#include "problem/nodes.glsl"
#include "common/counters.glsl"
#include "traversal/verdicts.glsl"
#include "problem/instances.glsl"
#define LEAF_QUEUE GROUP_SIZE
#include "traversal/leaf_queue.glsl"
layout(binding = UNIT_LEAF_PAIRS) uniform usamplerBuffer listed_leaf_pairs;

void main()
{
  const uint count = counters[COUNTER_LEAF_PAIRS];
  const uint first = min(groupIndex() * GROUP_SIZE, count);
  const uint here = min(count - first, uint(GROUP_SIZE));
  if (gl_LocalInvocationID.x < here)
    leaf_pairs[gl_LocalInvocationID.x] = texelFetch(listed_leaf_pairs, int(first + gl_LocalInvocationID.x));
  testLeafPairs(here);
}
