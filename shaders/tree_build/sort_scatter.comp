// Radix sort (sort_digit.glsl), step 3 of 3. One invocation per CHUNK keys moves them to their places in order, so that
// the sort is stable.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/sort_digit.glsl"
layout(std430, binding = BINDING_COUNTS) readonly buffer Counts { uint counts[]; };
layout(std430, binding = BINDING_KEYS_OUT) writeonly buffer KeysOut { uvec2 keys_out[]; };

void main()
{
  const uint invocation = invocationIndex();
  const uint invocations = (key_count + CHUNK - 1u) / CHUNK;
  if (invocation >= invocations)
    return;
  uint next[RADIX_SIZE];
  for (uint d = 0u; d < RADIX_SIZE; ++d)
    next[d] = counts[d * invocations + invocation];
  const uint end = min((invocation + 1u) * CHUNK, key_count);
  for (uint i = invocation * CHUNK; i < end; ++i)
  {
    const uvec2 key = keys_in[i];
    keys_out[next[digitOf(key)]++] = key;
  }
}
