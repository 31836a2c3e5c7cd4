// The proof of a pair of a robot instance and an object by the balls of the instance.
#include "proofs/distances.glsl"
#include "proofs/covers.glsl"

// STATE_HIT, 0 if the pair is apart, or STATE_UNDECIDED if nothing is proven. `to_object`: the frame of the instance in
// the frame of the object; `cover`, `inner`: see records.glsl. The balls are those from `begin` to `end` - 1.
uint proveByBalls(ProofInstance instance, ProofObject object, FrameRows to_object, float cover, float inner, uint begin,
                  uint end)
{
  const bool is_solid = object.kind != OBJECT_BOUNDING_BOX;
  bool apart = true;
  bool hit = false;
  for (uint first = begin; first < end && !hit; first += TEXEL_WORDS)
  {
    const vec4 radii = innerRadii(instance, first);
    for (uint k = 0u; k < TEXEL_WORDS; ++k)
    {
      const vec4 outer = outerBall(instance, first + k);
      const float squared = squaredDistanceFrom(object, placedIn(to_object, outer.xyz));
      apart = apart && isBeyond(squared, outer.w + cover);
      float squared_inner = squared;
      for (bool other = !instance.same_centers; other; other = false)
        squared_inner = squaredDistanceFrom(object, placedIn(to_object, witness(instance, first + k)));
      hit = hit || (is_solid && isWithin(squared_inner, radii[k] + inner));
    }
  }
  return hit ? STATE_HIT : apart ? 0u : STATE_UNDECIDED;
}

// Of the world pair `number` in a state. Writes the packed pair.
uint proveWorldPair(Records records, uint state, uint number, uint begin, uint end, out uint pair)
{
  const uvec4 words = proofWords(records.world_pairs + number);
  pair = words.x;
  const ProofInstance instance = fetchProofInstance(records.instances, pairRobot(pair));
  const ProofObject object = fetchProofObject(records.objects + OBJECT_TEXELS * (pairOther(pair) - robot_count));
  const FrameRows to_object = inObject(object, fetchFrame(state, instance.frame));
  const float cover = uintBitsToFloat(words.y) + grownMargin(worldMargin(state, pairRobot(pair)));
  return proveByBalls(instance, object, to_object, cover, uintBitsToFloat(words.z), begin, end);
}
