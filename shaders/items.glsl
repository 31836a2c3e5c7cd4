// An item is a pair of tree instances in one state, whose root boxes overlap. Four texels: the rows of b's pose in a's
// frame, then state, pair, slack and error.
#include "pose.glsl"

struct Item
{
  Pose pose;
  uint state;
  uint pair;
  float slack;  // the true surfaces lie at most this much outside of the triangles, metres (sum of both)
  float error;  // bound on the displacement of b's points by rounding, metres
};

#ifndef WRITES_ITEMS
layout(binding = UNIT_ITEMS) uniform usamplerBuffer item_texels;

Item fetchItem(uint index)
{
  const int at = int(4u * index);
  const uvec4 tail = texelFetch(item_texels, at + 3);
  const Pose pose = poseFromRows(uintBitsToFloat(texelFetch(item_texels, at)), uintBitsToFloat(texelFetch(item_texels, at + 1)),
                                 uintBitsToFloat(texelFetch(item_texels, at + 2)));
  return Item(pose, tail.x, tail.y, uintBitsToFloat(tail.z), uintBitsToFloat(tail.w));
}
#endif
