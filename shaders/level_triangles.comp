// One lane per (leaf pair, triangle of a's leaf): its tests against b's leaf.
#include "interface.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common.glsl"
#include "items.glsl"
#include "boxes.glsl"
#include "counters.glsl"
#include "verdicts.glsl"
#include "leaf_pair.glsl"
layout(binding = UNIT_LEAF_PAIRS) uniform usamplerBuffer leaf_pairs;

void main()
{
  const uint slot = invocationIndex();
  if (slot / LEAF_TRIANGLES >= counters[COUNTER_LEAF_PAIRS])
    return;
  const uvec4 pair = texelFetch(leaf_pairs, int(slot / LEAF_TRIANGLES));
  testLeafTriangle(pair.x, slot % LEAF_TRIANGLES, pair.y, pair.z);
}
