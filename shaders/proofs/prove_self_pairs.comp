// One invocation per open pair of robot instances: their boxes decide most of them.
#include "shader_constants.h"
layout(local_size_x = GROUP_SIZE) in;
#include "common/invocation.glsl"
#include "common/comparisons.glsl"
#include "geometry/pose.glsl"
#include "problem/instance_lists.glsl"
#include "problem/margins.glsl"
#include "proofs/records.glsl"
#include "proofs/covers.glsl"
#include "proofs/boxes.glsl"
#include "proofs/fine_pairs.glsl"
#include "traversal/verdicts.glsl"

void main()
{
  const uint i = invocationIndex();
  if (i >= lengthOf(LIST_OPEN_SELF_PAIRS, open_pair_capacity))
    return;
  const uvec2 entry = open_self_pairs[i];
  const uint state = entry.x;
  if (isSettled(state))
    return;
  const Records records = fetchRecords();
  const uint at = records.self_pairs + SELF_PAIR_TEXELS * entry.y;
  const uint pair = proofWords(at).x;
  const ProofInstance a = fetchProofInstance(records.instances, pairRobot(pair));
  const ProofInstance b = fetchProofInstance(records.instances, pairOther(pair));
  const float margin = grownMargin(selfMargin(state, pairRobot(pair), pairOther(pair)));
  const vec2 thresholds = proofNumbers(at + 1u).xy + vec2(margin, 0.0);
  const bool apart = boxesApart(a, fetchFrame(state, a.frame), b, fetchFrame(state, b.frame), thresholds);
  for (bool open = !apart; open; open = false)
    addFinePair(state, entry.y);
}
