// Lists of a part that grow on the device. A list has LIST_WORDS counters: the work groups for a dispatch over it (x, y
// and z), then its length. The groups are counted while the list grows, so no step between two dispatches computes
// them. A full list sets COUNTER_OVERFLOW. `group`: how many entries a work group handles.
#include "common/counters.glsl"

// Counts new entries of a list, and returns the place of the first one. An entry at `capacity` or beyond must not be
// written.
uint newEntries(uint list, uint count, uint capacity, uint group)
{
  const uint at = atomicAdd(counters[list + LIST_LENGTH], count);
  if (at + count > capacity)
    atomicOr(counters[COUNTER_OVERFLOW], 1u);
  const uint before = (min(at, capacity) + group - 1u) / group;
  const uint after = (min(at + count, capacity) + group - 1u) / group;
  if (after > before)
    atomicAdd(counters[list], after - before);
  return at;
}

uint lengthOf(uint list, uint capacity)
{
  return min(counters[list + LIST_LENGTH], capacity);
}
