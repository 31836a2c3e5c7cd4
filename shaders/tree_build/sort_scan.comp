// Radix sort (sort_digit.glsl), step 2 of 3. One work group computes the exclusive prefix sums of the counts, in place.
#include "shader_constants.h"
layout(local_size_x = SCAN_INVOCATIONS) in;
#include "common/invocation.glsl"
layout(location = LOCATION_VALUE_COUNT) uniform uint value_count;
layout(std430, binding = BINDING_COUNTS) buffer Counts { uint counts[]; };

#define SCAN_TYPE uint
#define SCAN_VALUES counts
#include "common/prefix_sum.glsl"

void main()
{
  scanInPlace(value_count);
}
