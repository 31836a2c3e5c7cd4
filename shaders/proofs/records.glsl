// The scene as the proofs read it: src/collision/cpu/lanes/lane_model.h in texels, which
// src/collision/gpu/proofs/proof_texels.cpp writes. Lengths are in metres. Texels of a record, in this order:
//   cells:          of the tables, one table after the other: TABLE_*
//   frame:          the first of its centres, their end
//   center:         of an attached object, or of a cluster with one, in its frame, and its number
//   self group:     its two centres, 16 bits each; its reach; its first pair, their end
//   self pair:      its instances; apart beyond this distance of the centres; cover, inner. Then the thresholds of the
//                   boxes
//   world instance: for each robot instance: its first group, their end; the radius of its enclosing ball
//   world group:    the centre of its box, its first pair; half lengths, the end of its pairs
//   world box:      for each world pair: along each axis, the ends of a box around the object, grown by the threshold
//                   of enclosing balls: 16 bits each, in steps of the half length of the group's box
//   world pair:     its instances, cover, inner
//   object:         three rows of the pose of the planning frame in its frame; half lengths, kind
//   instance:       its frame, 1 if witnesses are centres; three axes with half lengths and the centre of its box; the
//                   outer balls; the radii of the inner balls, four a texel; the centres of the inner balls (witnesses)
// cover: the outer balls are apart if their distance is greater than their radii plus this. inner: the inner balls
// collide if it is less than their radii plus this, which may be negative.
layout(binding = UNIT_PROOFS) uniform usamplerBuffer proof_texels;

uvec4 proofWords(uint texel)
{
  return texelFetch(proof_texels, int(texel));
}

vec4 proofNumbers(uint texel)
{
  return uintBitsToFloat(texelFetch(proof_texels, int(texel)));
}

// The first texel of each kind of records, and how many records the loops run over.
struct Records
{
  uint frames, centers, first_attached;
  uint self_groups, self_group_count, all_self_group_count, self_pairs;
  uint world_instances, world_groups, world_boxes, world_pairs;
  uint objects, instances, self_pair_count;
};

Records fetchRecords()
{
  const uvec4 a = proofWords(0u);
  const uvec4 b = proofWords(1u);
  const uvec4 c = proofWords(2u);
  const uvec4 d = proofWords(3u);
  return Records(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z, c.w, d.x, d.y);
}

struct ProofObject
{
  vec4 x;  // rows
  vec4 y;
  vec4 z;
  vec3 half_lengths;
  uint kind;  // OBJECT_*
};

ProofObject fetchProofObject(uint texel)
{
  const uvec4 last = proofWords(texel + 3u);
  return ProofObject(proofNumbers(texel), proofNumbers(texel + 1u), proofNumbers(texel + 2u),
                     uintBitsToFloat(last.xyz), last.w);
}

// A point in a frame with the rows x, y and z.
vec3 placedBy(vec4 x, vec4 y, vec4 z, vec3 p)
{
  precise const vec3 placed = vec3(fma(x.x, p.x, fma(x.y, p.y, fma(x.z, p.z, x.w))),
                                   fma(y.x, p.x, fma(y.y, p.y, fma(y.z, p.z, y.w))),
                                   fma(z.x, p.x, fma(z.y, p.y, fma(z.z, p.z, z.w))));
  return placed;
}

// A margin of a batch, grown by the rounding of its sums and their squares.
float grownMargin(float margin)
{
  return margin * (1.0 + 64.0 * UNIT_ROUNDOFF);
}

// True if a squared distance is proven to be greater than a length, which is not negative.
bool isBeyond(float squared, float length)
{
  return provenGreater(squared, length * length);
}

// True if a squared distance is proven to be less than a length.
bool isWithin(float squared, float length)
{
  return length > LEAST_PROVEN_LENGTH && provenGreater(length * length, squared);
}
