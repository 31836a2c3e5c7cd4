// The list of pairs of both kinds that the first tests of open pairs leave open. An entry is a state and the number of
// the pair: first the self pairs, then those with the world.
#include "proofs/open_pairs.glsl"
layout(std430, binding = BINDING_A) buffer FinePairs { uvec2 fine_pairs[]; };

void addFinePair(uint state, uint number)
{
  const uint at = newEntries(LIST_FINE_PAIRS, 1u, open_pair_capacity, GROUP_SIZE);
  if (at < open_pair_capacity)
    fine_pairs[at] = uvec2(state, number);
}
