// Triangles of one leaf against triangles of another.
#include "triangle_pair.glsl"
layout(binding = UNIT_TRIANGLES) uniform usamplerBuffer triangle_texels;

void fetchTriangle(uint index, out vec3 corners[3])
{
  for (int i = 0; i < 3; ++i)
    corners[i] = uintBitsToFloat(texelFetch(triangle_texels, int(3u * index) + i).xyz);
}

// Triangle `a` of a's mesh against up to LEAF_TRIANGLES of b's.
void testTriangles(Item item, uint a, uint b_first, uint b_count)
{
  vec3 corners_a[3];
  fetchTriangle(a, corners_a);
  bool hit = false;
  bool undecided = false;
  for (uint j = 0u; j < uint(LEAF_TRIANGLES); ++j)
  {
    vec3 corners_b[3];
    fetchTriangle(b_first + min(j, b_count - 1u), corners_b);
    for (int k = 0; k < 3; ++k)
      corners_b[k] = apply(item.pose, corners_b[k]);
    const uint result = trianglePair(corners_a, corners_b, item.error, item.slack);
    hit = hit || result == HIT;
    undecided = undecided || result == UNDECIDED;
  }
  if (hit)
    reportHit(item.state, item.pair);
  else if (undecided)
    reportUndecided(item.state);
}
