// The list of candidates: pairs of instances in a state whose root boxes must still be tested. A full list sets
// COUNTER_OVERFLOW.
#include "common/counters.glsl"
layout(location = LOCATION_CANDIDATE_CAPACITY) uniform uint candidate_capacity;
layout(std430, binding = BINDING_B) writeonly buffer Candidates { uvec2 candidates[]; };

void addCandidate(uint state, uint pair)
{
  const uint at = atomicAdd(counters[COUNTER_CANDIDATES], 1u);
  if (at < candidate_capacity)
    candidates[at] = uvec2(state, pair);
  else
    atomicOr(counters[COUNTER_OVERFLOW], 1u);
}
