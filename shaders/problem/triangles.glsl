// The triangles of all trees, in leaf order: three texels with the corners, metres, in the shape's frame.
layout(binding = UNIT_TRIANGLES) uniform usamplerBuffer triangle_texels;

void fetchTriangle(uint index, out vec3 corners[3])
{
  for (int i = 0; i < 3; ++i)
    corners[i] = uintBitsToFloat(texelFetch(triangle_texels, int(3u * index) + i).xyz);
}
