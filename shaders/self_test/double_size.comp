// Never runs. The size of this program with and without MULTIPLY_ADDS shows whether the device emulates double
// precision.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
layout(std430, binding = BINDING_C) readonly buffer Numbers { dvec2 numbers[]; };
layout(std430, binding = BINDING_A) writeonly buffer Results { double results[]; };

void main()
{
  const uint i = invocationIndex();
  const dvec2 n = numbers[i];
  double x = n.x;
#if MULTIPLY_ADDS == 4
  x = x * n.y + n.y;
  x = x * n.x + n.y;
  x = x * n.y + n.x;
  x = x * n.x + n.x;
#endif
  results[i] = x;
}
