// One lane: indirect arguments for dispatches over a list of `counter` elements, at most `capacity`, and of at most
// `max_groups` workgroups of `lanes` lanes; `cleared` starts again from 0. The lanes are counted.
#include "interface.h"
layout(local_size_x = 1) in;
#include "counters.glsl"
#include "arguments.glsl"
layout(location = 0) uniform uint counter;
layout(location = 1) uniform uint capacity;
layout(location = 2) uniform uint lanes;
layout(location = 3) uniform uint max_groups;
layout(location = 4) uniform uint arguments;  // where they go among the counters
layout(location = 5) uniform uint cleared;

void main()
{
  const uint count = min(counters[counter], capacity);
  const uint groups = min((count + lanes - 1u) / lanes, max_groups);
  setGroups(arguments, groups);
  // Right where the lanes count themselves: setGroups rounds up only past QUEUE_MAX_GROUPS.
  counters[COUNTER_LANES_STARTED] += groups * lanes;
  counters[cleared] = 0u;
}
