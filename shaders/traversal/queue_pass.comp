// One invocation, before each pass of the work queues and after the last one. It checks that the previous pass took all
// its entries and that all its invocations reached their end, and sets COUNTER_OVERFLOW if not. Then it writes the
// arguments of the next pass.
#include "shader_constants.h"
layout(local_size_x = 1) in;
#include "common/counters.glsl"
#include "common/indirect_arguments.glsl"
layout(location = LOCATION_IN_COUNTER) uniform uint in_counter;   // of the list that the next pass reads
layout(location = LOCATION_IN_CAPACITY) uniform uint in_capacity;
layout(location = LOCATION_OUT_COUNTER) uniform uint out_counter;  // of the list that the next pass writes
// 1: no further pass follows, so entries that are left are an overflow.
layout(location = LOCATION_IS_LAST) uniform uint is_last;

void main()
{
  const uint count = min(counters[in_counter], in_capacity);
  if (counters[COUNTER_NEXT_ENTRY] < counters[COUNTER_PASS_ENTRIES] ||
      counters[COUNTER_INVOCATIONS_ENDED] != counters[COUNTER_INVOCATIONS_STARTED] ||
      (is_last != 0u && count != 0u))
    counters[COUNTER_OVERFLOW] = 1u;
  const uint groups = min((count + QUEUE_INVOCATIONS - 1u) / QUEUE_INVOCATIONS, QUEUE_MAX_GROUPS);
  setGroups(COUNTER_ARGUMENTS, groups);
  counters[COUNTER_PASS_ENTRIES] = is_last != 0u ? 0u : count;
  counters[COUNTER_INVOCATIONS_STARTED] = is_last != 0u ? 0u : groups * QUEUE_INVOCATIONS;
  counters[COUNTER_INVOCATIONS_ENDED] = 0u;
  counters[COUNTER_NEXT_ENTRY] = 0u;
  counters[out_counter] = 0u;
}
