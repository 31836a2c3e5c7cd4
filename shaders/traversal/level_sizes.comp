// Step 2 of a level (level.glsl). One work group: computes the exclusive prefix sums of the groups' sums, the sizes of
// the next level and of the leaf list, and the indirect arguments for both. It sets COUNTER_OVERFLOW if a list is too
// short, before anything is written to it.
#include "shader_constants.h"
layout(local_size_x = SCAN_INVOCATIONS) in;
#include "common/counters.glsl"
#include "common/indirect_arguments.glsl"
layout(location = LOCATION_IN_COUNTER) uniform uint in_counter;
layout(location = LOCATION_OUT_COUNTER) uniform uint out_counter;
layout(location = LOCATION_ENTRY_CAPACITY) uniform uint entry_capacity;
layout(location = LOCATION_LEAF_PAIR_CAPACITY) uniform uint leaf_pair_capacity;
layout(location = LOCATION_IN_CAPACITY) uniform uint in_capacity;  // of the list that is read
layout(location = LOCATION_IS_LAST) uniform uint is_last;  // 1 for the deepest level that is possible
layout(std430, binding = BINDING_B) buffer Sums { uvec2 sums[]; };

#define SCAN_TYPE uvec2
#define SCAN_VALUES sums
#include "common/prefix_sum.glsl"

void main()
{
  const uint entry_count = min(counters[in_counter], in_capacity);
  const uvec2 total = scanInPlace((entry_count + LEVEL_GROUP - 1u) / LEVEL_GROUP);
  if (gl_LocalInvocationID.x == 0u)
  {
    // The deepest possible level has no node pairs for a next level.
    if (total.x > entry_capacity || total.y > leaf_pair_capacity || (is_last != 0u && total.x != 0u))
      counters[COUNTER_OVERFLOW] = 1u;
    const uvec2 kept = min(total, uvec2(entry_capacity, leaf_pair_capacity));
    counters[out_counter] = kept.x;
    counters[COUNTER_LEAF_PAIRS] = kept.y;
    // level_children.comp runs with the arguments of this level. NVIDIA's compiler refuses a loop over them: it unrolls
    // the loop and then reports "lvalue in array access too complex".
    counters[COUNTER_CHUNK_ARGUMENTS] = counters[COUNTER_ARGUMENTS];
    counters[COUNTER_CHUNK_ARGUMENTS + 1u] = counters[COUNTER_ARGUMENTS + 1u];
    counters[COUNTER_CHUNK_ARGUMENTS + 2u] = counters[COUNTER_ARGUMENTS + 2u];
    setGroups(COUNTER_ARGUMENTS, (kept.x + LEVEL_GROUP - 1u) / LEVEL_GROUP);
    setGroups(COUNTER_LEAF_ARGUMENTS, (kept.y + GROUP_SIZE - 1u) / GROUP_SIZE);
  }
}
