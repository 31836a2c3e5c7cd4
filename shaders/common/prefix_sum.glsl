// Exclusive prefix sums of SCAN_VALUES[0 .. count), an array of SCAN_TYPE, in place, by one work group of SCAN_LANES
// invocations. Each invocation sums a contiguous part. One invocation scans the sums of the parts in shared memory.
// Then each invocation writes its part. All invocations must call scanInPlace, and each gets the sum of all values.
#define SCAN_LANES 256

shared SCAN_TYPE part_sums[SCAN_LANES];
shared SCAN_TYPE sum_of_parts;

SCAN_TYPE scanInPlace(uint count)
{
  const uint lane = gl_LocalInvocationID.x;
  const uint part = (count + SCAN_LANES - 1u) / SCAN_LANES;
  const uint begin = min(lane * part, count);
  const uint end = min(begin + part, count);
  SCAN_TYPE sum = SCAN_TYPE(0u);
  for (uint i = begin; i < end; ++i)
    sum += SCAN_VALUES[i];
  part_sums[lane] = sum;
  barrier();
  if (lane == 0u)
  {
    SCAN_TYPE running = SCAN_TYPE(0u);
    for (uint i = 0u; i < SCAN_LANES; ++i)
    {
      const SCAN_TYPE value = part_sums[i];
      part_sums[i] = running;
      running += value;
    }
    sum_of_parts = running;
  }
  barrier();
  SCAN_TYPE offset = part_sums[lane];
  for (uint i = begin; i < end; ++i)
  {
    const SCAN_TYPE value = SCAN_VALUES[i];
    SCAN_VALUES[i] = offset;
    offset += value;
  }
  return sum_of_parts;
}
