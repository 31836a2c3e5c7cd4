// The proof of a pair of robot instances by their coarse balls. Pairs of fine balls would cost as much as the trees.
#include "proofs/covers.glsl"
#include "proofs/boxes.glsl"

// STATE_HIT, 0 if the pair is apart, or STATE_UNDECIDED if nothing is proven. `to_a`: the frame of b in the frame of a;
// `cover`, `inner`: see records.glsl.
uint proveByPairsOfBalls(ProofInstance a, ProofInstance b, FrameRows to_a, float cover, float inner)
{
  bool apart = true;
  for (uint j = 0u; j < COVER_COARSE_BALLS; ++j)
  {
    const vec4 outer_b = outerBall(b, j);
    const vec3 center = placedIn(to_a, outer_b.xyz);
    const vec3 witness_b = b.same_centers ? center : placedIn(to_a, witness(b, j));
    const float inner_b = innerRadii(b, j)[j % TEXEL_WORDS] + inner;
    for (uint i = 0u; i < COVER_COARSE_BALLS; ++i)
    {
      const vec4 outer_a = outerBall(a, i);
      const vec3 between = vectorBetween(outer_a.xyz, center);
      apart = apart && isBeyond(dot(between, between), outer_a.w + outer_b.w + cover);
      const vec3 inside = vectorBetween(a.same_centers ? outer_a.xyz : witness(a, i), witness_b);
      if (isWithin(dot(inside, inside), innerRadii(a, i)[i % TEXEL_WORDS] + inner_b))
        return STATE_HIT;
    }
  }
  return apart ? 0u : STATE_UNDECIDED;
}

// Of the self pair `number` in a state. Writes the packed pair.
uint proveSelfPair(Records records, uint state, uint number, out uint pair)
{
  const uvec4 words = proofWords(records.self_pairs + SELF_PAIR_TEXELS * number);
  pair = words.x;
  const ProofInstance a = fetchProofInstance(records.instances, pairRobot(pair));
  const ProofInstance b = fetchProofInstance(records.instances, pairOther(pair));
  const FrameRows to_a = relativeFrame(fetchFrame(state, a.frame), fetchFrame(state, b.frame));
  const float margin = grownMargin(selfMargin(state, pairRobot(pair), pairOther(pair)));
  return proveByPairsOfBalls(a, b, to_a, uintBitsToFloat(words.z) + margin, uintBitsToFloat(words.w));
}
