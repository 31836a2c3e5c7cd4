// One invocation per pair that boxes or coarse balls left open: pairs of links are tested by their coarse balls, pairs
// with the world by the fine balls. A pair without a proof becomes a candidate for the trees.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "common/comparisons.glsl"
#include "geometry/pose.glsl"
#include "problem/instance_lists.glsl"
#include "problem/margins.glsl"
#include "proofs/records.glsl"
#include "proofs/world_pair.glsl"
#include "proofs/self_pair.glsl"
#include "proofs/fine_pairs.glsl"
#include "proofs/open_states.glsl"

void main()
{
  const uint i = invocationIndex();
  if (i >= lengthOf(LIST_FINE_PAIRS, open_pair_capacity))
    return;
  const uvec2 entry = fine_pairs[i];
  if (isSettled(entry.x))
    return;
  const Records records = fetchRecords();
  const bool is_self = entry.y < records.self_pair_count;
  uint proof = 0u;
  uint pair = 0u;
  // The loops stand for branches, as in state_proofs.glsl.
  for (bool chosen = is_self; chosen; chosen = false)
    proof = proveSelfPair(records, entry.x, entry.y, pair);
  for (bool chosen = !is_self; chosen; chosen = false)
    proof = proveWorldPair(records, entry.x, entry.y - records.self_pair_count, COVER_COARSE_BALLS, COVER_BALLS, pair);
  if (proof == STATE_HIT)
    report(entry.x, pair, proof);
  for (bool open = proof == STATE_UNDECIDED; open; open = false)
    leaveOpen(entry.x, pair);
}
