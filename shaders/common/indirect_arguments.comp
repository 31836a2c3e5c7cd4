// One lane: indirect arguments for dispatches over a list of `counter` elements, at most `capacity`, and of
// workgroups of `lanes` lanes; `cleared` starts again from 0.
#include "shader_constants.h"
layout(local_size_x = 1) in;
#include "common/counters.glsl"
#include "common/indirect_arguments.glsl"
layout(location = LOCATION_COUNTER) uniform uint counter;
layout(location = LOCATION_CAPACITY) uniform uint capacity;
layout(location = LOCATION_LANES) uniform uint lanes;
layout(location = LOCATION_ARGUMENT_OFFSET) uniform uint argument_offset;  // where they go among the counters
layout(location = LOCATION_CLEARED) uniform uint cleared;

void main()
{
  const uint count = min(counters[counter], capacity);
  setGroups(argument_offset, (count + lanes - 1u) / lanes);
  counters[cleared] = 0u;
}
