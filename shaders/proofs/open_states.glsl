// The list of the states with candidates. Only their links are placed in double.
#include "common/lists.glsl"
#include "traversal/verdicts.glsl"
#include "broad_phase/candidates.glsl"
layout(std430, binding = BINDING_OPEN_STATES) writeonly buffer OpenStates { uint open_states[]; };

// Adds a pair that the proofs leave open to the candidates.
void leaveOpen(uint state, uint pair)
{
  addCandidate(state, pair);
  if (atomicCompSwap(verdicts[state], VERDICT_FREE, VERDICT_OPEN) == VERDICT_FREE)
    open_states[newEntries(LIST_OPEN_STATES, 1u, state_count, GROUP_SIZE)] = state;
}
