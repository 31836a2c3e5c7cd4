// One invocation per open pair of a robot instance and an object: the coarse balls of the instance decide most of them.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "common/comparisons.glsl"
#include "geometry/pose.glsl"
#include "problem/instance_lists.glsl"
#include "problem/margins.glsl"
#include "proofs/records.glsl"
#include "proofs/world_pair.glsl"
#include "proofs/fine_pairs.glsl"
#include "traversal/verdicts.glsl"

void main()
{
  const uint i = invocationIndex();
  if (i >= lengthOf(LIST_OPEN_WORLD_PAIRS, open_pair_capacity))
    return;
  const uvec2 entry = open_world_pairs[i];
  if (isSettled(entry.x))
    return;
  const Records records = fetchRecords();
  uint pair;
  const uint proof = proveWorldPair(records, entry.x, entry.y, 0u, COVER_COARSE_BALLS, pair);
  if (proof == STATE_HIT)
    report(entry.x, pair, proof);
  for (bool open = proof == STATE_UNDECIDED; open; open = false)
    addFinePair(entry.x, records.self_pair_count + entry.y);
}
