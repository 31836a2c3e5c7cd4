// Radix sort, step 2 of 3: exclusive prefix sums of the counts, in place, by one workgroup. Each lane sums a contiguous
// part, the parts are scanned in shared memory, then each lane writes its part.
layout(local_size_x = 256) in;
#include "common.glsl"
layout(location = 0) uniform uint value_count;
layout(std430, binding = 4) buffer Counts { uint counts[]; };

shared uint part_sums[256];

void main()
{
  const uint lane = gl_LocalInvocationID.x;
  const uint part = (value_count + 255u) / 256u;
  const uint begin = min(lane * part, value_count);
  const uint end = min(begin + part, value_count);
  uint sum = 0u;
  for (uint i = begin; i < end; ++i)
    sum += counts[i];
  part_sums[lane] = sum;
  barrier();
  if (lane == 0u)
  {
    uint total = 0u;
    for (uint i = 0u; i < 256u; ++i)
    {
      const uint value = part_sums[i];
      part_sums[i] = total;
      total += value;
    }
  }
  barrier();
  uint offset = part_sums[lane];
  for (uint i = begin; i < end; ++i)
  {
    const uint value = counts[i];
    counts[i] = offset;
    offset += value;
  }
}
