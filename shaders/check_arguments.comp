// One lane: indirect arguments for dispatches over a list of `counter` elements, at most `capacity`, and of
// workgroups of `lanes` lanes; `cleared` starts again from 0.
#include "interface.h"
layout(local_size_x = 1) in;
#include "counters.glsl"
#include "arguments.glsl"
layout(location = 0) uniform uint counter;
layout(location = 1) uniform uint capacity;
layout(location = 2) uniform uint lanes;
layout(location = 3) uniform uint arguments;  // where they go among the counters
layout(location = 4) uniform uint cleared;

void main()
{
  const uint count = min(counters[counter], capacity);
  setGroups(arguments, (count + lanes - 1u) / lanes);
  counters[cleared] = 0u;
}
