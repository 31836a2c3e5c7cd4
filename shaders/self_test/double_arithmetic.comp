// One invocation per pair of numbers: records the device's results in double precision, and their rounding to float.
// src/gpu/float_arithmetic.cpp checks them.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
layout(location = LOCATION_CASE_COUNT) uniform uint case_count;
layout(std430, binding = BINDING_C) readonly buffer Numbers { dvec2 numbers[]; };
// results: the sum, the product, the quotient, and the square root of the product's absolute value. rounded: the
// product as a float.
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
