// One invocation: writes the indirect arguments of dispatches over a list, with `invocations` elements for each work
// group. In: counters[counter], the length of the list; the list holds at most `capacity` elements. Out: three uints
// from counters[argument_offset] on. It also sets counters[cleared] to 0.
#include "shader_constants.h"
layout(local_size_x = 1) in;
#include "common/counters.glsl"
#include "common/indirect_arguments.glsl"
layout(location = LOCATION_COUNTER) uniform uint counter;
layout(location = LOCATION_CAPACITY) uniform uint capacity;
layout(location = LOCATION_INVOCATIONS) uniform uint invocations;
layout(location = LOCATION_ARGUMENT_OFFSET) uniform uint argument_offset;  // place of the arguments among the counters
layout(location = LOCATION_CLEARED) uniform uint cleared;

void main()
{
  const uint count = min(counters[counter], capacity);
  setGroups(argument_offset, (count + invocations - 1u) / invocations);
  counters[cleared] = 0u;
}
