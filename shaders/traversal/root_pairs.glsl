// A root pair is a pair of tree instances in one state, whose root boxes overlap. Five texels: the rows of b's pose in a's
// frame; state, pair, error and gap; the required distance. a is the pair's second instance (of a robot and a world
// instance the world's, so that it is the smaller shape whose points are moved), b its first.
#include "geometry/pose.glsl"

struct RootPair
{
  Pose pose;
  uint state;
  uint pair;
  float error;  // bound on the displacement of b's points against a's by rounding, metres
  float gap;    // triangles that are further apart than this do not make the pair collide, metres
};

#ifndef WRITES_ITEMS
layout(binding = UNIT_ROOT_PAIRS) uniform usamplerBuffer item_texels;

RootPair fetchRootPair(uint index)
{
  const int at = int(index) * ROOT_PAIR_TEXELS;
  const uvec4 tail = texelFetch(item_texels, at + 3);
  const Pose pose = poseFromRows(uintBitsToFloat(texelFetch(item_texels, at)), uintBitsToFloat(texelFetch(item_texels, at + 1)),
                                 uintBitsToFloat(texelFetch(item_texels, at + 2)));
  return RootPair(pose, tail.x, tail.y, uintBitsToFloat(tail.z), uintBitsToFloat(tail.w));
}

uint fetchState(uint index)
{
  return texelFetch(item_texels, int(index) * ROOT_PAIR_TEXELS + 3).x;
}

// At a distance up to this one, in metres, the pair collides.
float fetchDistance(uint index)
{
  return uintBitsToFloat(texelFetch(item_texels, int(index) * ROOT_PAIR_TEXELS + 4).x);
}
#endif
