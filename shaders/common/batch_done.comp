// One invocation, in the last dispatch of a part: writes the serial number of the part. This number proves to the host
// that no earlier dispatch of the part was dropped.
#include "shader_constants.h"
layout(local_size_x = 1) in;
#include "common/counters.glsl"
layout(location = LOCATION_SERIAL) uniform uint serial;

void main()
{
  counters[COUNTER_DONE] = serial;
}
