// Exclusive prefix sums of SCAN_VALUES[0 .. count), an array of SCAN_TYPE, in place, by one work group of
// SCAN_INVOCATIONS invocations. Each invocation sums a contiguous part. One invocation scans the sums of the parts in
// shared memory. Then each invocation writes its part. All invocations must call scanInPlace, and each gets the sum of
// all values. Source: G. E. Blelloch, "Prefix Sums and Their Applications", 1990.

shared SCAN_TYPE part_sums[SCAN_INVOCATIONS];
shared SCAN_TYPE sum_of_parts;

SCAN_TYPE scanInPlace(uint count)
{
  const uint invocation = gl_LocalInvocationID.x;
  const uint part = (count + SCAN_INVOCATIONS - 1u) / SCAN_INVOCATIONS;
  const uint begin = min(invocation * part, count);
  const uint end = min(begin + part, count);
  SCAN_TYPE sum = SCAN_TYPE(0u);
  for (uint i = begin; i < end; ++i)
    sum += SCAN_VALUES[i];
  part_sums[invocation] = sum;
  barrier();
  if (invocation == 0u)
  {
    SCAN_TYPE running = SCAN_TYPE(0u);
    for (uint i = 0u; i < SCAN_INVOCATIONS; ++i)
    {
      const SCAN_TYPE value = part_sums[i];
      part_sums[i] = running;
      running += value;
    }
    sum_of_parts = running;
  }
  barrier();
  SCAN_TYPE offset = part_sums[invocation];
  for (uint i = begin; i < end; ++i)
  {
    const SCAN_TYPE value = SCAN_VALUES[i];
    SCAN_VALUES[i] = offset;
    offset += value;
  }
  return sum_of_parts;
}
