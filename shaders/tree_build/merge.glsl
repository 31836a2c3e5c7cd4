// The fate of a cluster in a round. Two clusters that are each other's nearest neighbours merge, at the place of the
// lower one (Meister and Bittner 2018, see nearest.comp).
layout(location = LOCATION_ROUND_INDEX) uniform uint round_index;
layout(std430, binding = BINDING_ROUNDS) readonly buffer Rounds { uint rounds[]; };
layout(std430, binding = BINDING_NEAREST) readonly buffer Nearest { uint nearest[]; };

#define STAYS 0
#define MERGES 1
#define VANISHES 2

uint fateOf(uint i)
{
  const uint j = nearest[i];
  if (j == i || nearest[j] != i)
    return STAYS;
  return i < j ? MERGES : VANISHES;
}
