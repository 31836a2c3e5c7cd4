// One invocation per pair of numbers: records the device's results of the operations on which the error bounds rely.
// src/gpu/float_arithmetic.cpp checks them. Two-sum (Knuth 1969) and two-product (Dekker 1971) give the rounding error
// of one operation exactly. They do so only if the compiler does not reorder or contract `precise` expressions, and if
// the device rounds every operation properly.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
layout(location = LOCATION_CASE_COUNT) uniform uint case_count;
// The cases, and then two NaN. A compiler could fold an expression that gives NaN, and its comparisons.
layout(std430, binding = BINDING_C) readonly buffer Numbers { vec2 numbers[]; };
// First texel of a case: the sum and its error, the product and its error. Second texel: x * y minus the product (0
// unless the compiler contracts the two operations); the length of (x, y, x); 1 if a comparison with NaN is true; the
// dot product of (x, y, x) and (y, y, x).
layout(std430, binding = BINDING_A) writeonly buffer Results { vec4 results[]; };

void split(float x, out float high, out float low)
{
  precise const float scaled = 4097.0 * x;  // 2^12 + 1
  precise const float rest = scaled - x;
  precise const float upper = scaled - rest;
  high = upper;
  precise const float lower = x - upper;
  low = lower;
}

void main()
{
  const uint i = invocationIndex();
  if (i >= case_count)
    return;
  const float x = numbers[i].x;
  const float y = numbers[i].y;
  precise const float sum = x + y;
  precise const float y_part = sum - x;
  precise const float x_part = sum - y_part;
  precise const float sum_error = (x - x_part) + (y - y_part);
  precise const float product = x * y;
  float xh, xl, yh, yl;
  split(x, xh, xl);
  split(y, yh, yl);
  precise const float product_error = ((xh * yh - product) + xh * yl + xl * yh) + xl * yl;
  precise const float left = x * y - product;
  const float no_number = numbers[case_count].x;
  const bool holds = no_number > x || no_number < x || no_number >= x || no_number <= x || no_number == x;
  results[OUTCOME_TEXELS * i] = vec4(sum, sum_error, product, product_error);
  results[OUTCOME_TEXELS * i + 1u] =
      vec4(left, length(vec3(x, y, x)), holds ? 1.0 : 0.0, dot(vec3(x, y, x), vec3(y, y, x)));
}
