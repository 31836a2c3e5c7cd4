// One lane, the last of a part's work: its serial number says that nothing was dropped before.
#include "interface.h"
layout(local_size_x = 1) in;
#include "counters.glsl"
layout(location = 0) uniform uint serial;

void main()
{
  counters[COUNTER_DONE] = serial;
}
