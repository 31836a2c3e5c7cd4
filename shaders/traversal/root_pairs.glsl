// A root pair is a pair of instances in one state whose root boxes overlap. a is the second instance of the pair, b the
// first one. In a robot-world pair, a is the world's instance. So the points of the link are transformed: it is usually
// the smaller shape. Five texels: three rows of the pose of b in the frame of a; state, pair, error and gap; the
// required distance. Lengths are in metres.
#include "geometry/pose.glsl"

struct RootPair
{
  Pose pose;
  uint state;
  uint pair;
  float error;  // upper bound on the rounding error of the position of b's points relative to a's
  float gap;    // triangles at a larger distance do not make the pair collide
};

#ifndef WRITES_ROOT_PAIRS
layout(binding = UNIT_ROOT_PAIRS) uniform usamplerBuffer root_pair_texels;

RootPair fetchRootPair(uint index)
{
  const int at = int(index) * ROOT_PAIR_TEXELS;
  const uvec4 tail = texelFetch(root_pair_texels, at + 3);
  const Pose pose = poseFromRows(uintBitsToFloat(texelFetch(root_pair_texels, at)),
                                 uintBitsToFloat(texelFetch(root_pair_texels, at + 1)),
                                 uintBitsToFloat(texelFetch(root_pair_texels, at + 2)));
  return RootPair(pose, tail.x, tail.y, uintBitsToFloat(tail.z), uintBitsToFloat(tail.w));
}

uint fetchState(uint index)
{
  return texelFetch(root_pair_texels, int(index) * ROOT_PAIR_TEXELS + 3).x;
}

// The required distance in metres: the pair collides at this distance and below.
float fetchDistance(uint index)
{
  return uintBitsToFloat(texelFetch(root_pair_texels, int(index) * ROOT_PAIR_TEXELS + 4).x);
}
#endif
