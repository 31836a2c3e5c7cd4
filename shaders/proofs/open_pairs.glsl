// The lists of pairs that enclosing balls leave open: of two robot instances, and of a robot instance and an object. An
// entry is a state and the number of the pair among the pairs of its kind.
#include "common/lists.glsl"
layout(location = LOCATION_OPEN_PAIR_CAPACITY) uniform uint open_pair_capacity;
layout(std430, binding = BINDING_C) buffer OpenSelfPairs { uvec2 open_self_pairs[]; };
layout(std430, binding = BINDING_D) buffer OpenWorldPairs { uvec2 open_world_pairs[]; };

// The pairs from `first` on whose bits are set.
void addOpenSelfPairs(uint state, uint first, uint bits)
{
  for (bool any = bits != 0u; any; any = false)
  {
    uint at = newEntries(LIST_OPEN_SELF_PAIRS, bitCount(bits), open_pair_capacity, GROUP_SIZE);
    for (; bits != 0u && at < open_pair_capacity; bits &= bits - 1u)
      open_self_pairs[at++] = uvec2(state, first + uint(findLSB(bits)));
  }
}

void addOpenWorldPairs(uint state, uint first, uint bits)
{
  for (bool any = bits != 0u; any; any = false)
  {
    uint at = newEntries(LIST_OPEN_WORLD_PAIRS, bitCount(bits), open_pair_capacity, GROUP_SIZE);
    for (; bits != 0u && at < open_pair_capacity; bits &= bits - 1u)
      open_world_pairs[at++] = uvec2(state, first + uint(findLSB(bits)));
  }
}
