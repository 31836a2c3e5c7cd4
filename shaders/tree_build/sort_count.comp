// Radix sort (sort_digit.glsl), step 1 of 3. One invocation per CHUNK keys counts their digits. The digit is that of
// the key, or of the key's mesh.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "tree_build/sort_digit.glsl"
layout(std430, binding = BINDING_COUNTS) writeonly buffer Counts { uint counts[]; };  // [digit][invocation]

void main()
{
  const uint invocation = invocationIndex();
  const uint invocations = (key_count + CHUNK - 1u) / CHUNK;
  if (invocation >= invocations)
    return;
  uint count[RADIX_SIZE];
  for (uint d = 0u; d < RADIX_SIZE; ++d)
    count[d] = 0u;
  const uint end = min((invocation + 1u) * CHUNK, key_count);
  for (uint i = invocation * CHUNK; i < end; ++i)
    ++count[digitOf(keys_in[i])];
  for (uint d = 0u; d < RADIX_SIZE; ++d)
    counts[d * invocations + invocation] = count[d];
}
