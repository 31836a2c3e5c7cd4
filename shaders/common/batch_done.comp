// One lane, the last of a part's work: its serial number says that nothing was dropped before.
#include "shader_constants.h"
layout(local_size_x = 1) in;
#include "common/counters.glsl"
layout(location = LOCATION_SERIAL) uniform uint serial;

void main()
{
  counters[COUNTER_DONE] = serial;
}
