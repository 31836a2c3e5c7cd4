// The list of candidates: pairs of a robot instance and another instance or a half-space, in a state, that trees must
// decide unless their root boxes are apart.
#include "common/lists.glsl"
layout(location = LOCATION_CANDIDATE_CAPACITY) uniform uint candidate_capacity;
layout(std430, binding = BINDING_B) writeonly buffer Candidates { uvec2 candidates[]; };

void addCandidate(uint state, uint pair)
{
  const uint at = newEntries(LIST_CANDIDATES, 1u, candidate_capacity, GROUP_SIZE);
  if (at < candidate_capacity)
    candidates[at] = uvec2(state, pair);
}
