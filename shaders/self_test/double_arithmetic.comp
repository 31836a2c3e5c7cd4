// One lane per pair of numbers: what the device makes of double precision, and of its rounding to float.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
layout(location = LOCATION_CASE_COUNT) uniform uint case_count;
layout(std430, binding = BINDING_C) readonly buffer Numbers { dvec2 numbers[]; };
// Sum, product, quotient, square root of the product's amount; the product as a float.
layout(std430, binding = BINDING_A) writeonly buffer Results { dvec4 results[]; };
layout(std430, binding = BINDING_B) writeonly buffer Rounded { float rounded[]; };

void main()
{
  const uint i = invocationIndex();
  if (i >= case_count)
    return;
  const dvec2 n = numbers[i];
  results[i] = dvec4(n.x + n.y, n.x * n.y, n.x / n.y, sqrt(abs(n.x * n.y)));
  rounded[i] = float(n.x * n.y);
}
