// One invocation, in the last dispatch of a part: writes the serial number of the part. This number proves to the host
// that no earlier dispatch of the part was dropped. It also checks that each pass of the work queues took all its
// entries, and that all its invocations reached their end; if not, it sets COUNTER_OVERFLOW.
#include "shader_constants.h"
layout(local_size_x = 1) in;
#include "common/lists.glsl"
layout(location = LOCATION_SERIAL) uniform uint serial;
layout(location = LOCATION_HAS_QUEUES) uniform uint has_queues;  // 0: no pass was started
layout(location = LOCATION_ROOT_PAIR_CAPACITY) uniform uint root_pair_capacity;
layout(location = LOCATION_ENTRY_CAPACITY) uniform uint entry_capacity;

bool isUnfinished(uint list, uint capacity, uint pass_counters)
{
  return counters[pass_counters + PASS_NEXT_ENTRY] < lengthOf(list, capacity) ||
         counters[pass_counters + PASS_ENDED] != counters[list] * QUEUE_INVOCATIONS;
}

void main()
{
  if (has_queues != 0u && (isUnfinished(LIST_SOLID_ENTRIES, root_pair_capacity, PASS_SOLIDS) ||
                           isUnfinished(LIST_MESH_ENTRIES, root_pair_capacity, PASS_MESHES) ||
                           isUnfinished(LIST_SOLID_REST, entry_capacity, PASS_SOLID_REST) ||
                           isUnfinished(LIST_MESH_REST, entry_capacity, PASS_MESH_REST)))
    counters[COUNTER_OVERFLOW] = 1u;
  counters[COUNTER_DONE] = serial;
}
