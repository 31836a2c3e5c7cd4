// The list of the pairs of links that boxes leave open, and of the pairs with the world that coarse balls leave open.
// An entry is a state and the number of the pair. The self pairs are counted first, then the pairs with the world.
#include "proofs/open_pairs.glsl"
layout(std430, binding = BINDING_A) buffer FinePairs { uvec2 fine_pairs[]; };

void addFinePair(uint state, uint number)
{
  const uint at = newEntries(LIST_FINE_PAIRS, 1u, open_pair_capacity, GROUP_SIZE);
  if (at < open_pair_capacity)
    fine_pairs[at] = uvec2(state, number);
}
