// One workgroup: exclusive prefix sums of the chunks' sums, the sizes of the next level and of the leaf list, and the
// indirect arguments for both. A list that is too short is noticed here, before anything is written.
#include "interface.h"
layout(local_size_x = 256) in;
#include "counters.glsl"
#include "arguments.glsl"
layout(location = 0) uniform uint in_counter;
layout(location = 1) uniform uint out_counter;
layout(location = 2) uniform uint entry_capacity;
layout(location = 3) uniform uint leaf_pair_capacity;
layout(location = 4) uniform uint in_capacity;  // of the list read
layout(location = 5) uniform uint is_last;  // 1 for the deepest level that there can be
layout(std430, binding = BINDING_B) buffer Sums { uvec2 sums[]; };

#define SCAN_TYPE uvec2
#define SCAN_VALUES sums
#include "scan.glsl"

void main()
{
  const uint entry_count = min(counters[in_counter], in_capacity);
  const uvec2 total = scanInPlace((entry_count + LEVEL_CHUNK - 1u) / LEVEL_CHUNK);
  if (gl_LocalInvocationID.x == 0u)
  {
    // The last level of all leaves nothing for a next one.
    if (total.x > entry_capacity || total.y > leaf_pair_capacity || (is_last != 0u && total.x != 0u))
      counters[COUNTER_OVERFLOW] = 1u;
    const uvec2 kept = min(total, uvec2(entry_capacity, leaf_pair_capacity));
    counters[out_counter] = kept.x;
    counters[COUNTER_LEAF_PAIRS] = kept.y;
    // This level's arguments serve once more, for writing the next one.
    for (uint i = 0u; i < 3u; ++i)
      counters[COUNTER_CHUNK_ARGUMENTS + i] = counters[COUNTER_ARGUMENTS + i];
    const uint chunks = (kept.x + LEVEL_CHUNK - 1u) / LEVEL_CHUNK;
    setGroups(COUNTER_ARGUMENTS, (chunks + GROUP_SIZE - 1u) / GROUP_SIZE);
    setGroups(COUNTER_LEAF_ARGUMENTS, (kept.y + GROUP_SIZE - 1u) / GROUP_SIZE);
  }
}
