// The triangles of all trees, in leaf order. One texel for each corner, in the frame of the shape (metres).
layout(binding = UNIT_TRIANGLES) uniform usamplerBuffer triangle_texels;

void fetchTriangle(uint index, out vec3 corners[3])
{
  for (int i = 0; i < 3; ++i)
    corners[i] = uintBitsToFloat(texelFetch(triangle_texels, int(TRIANGLE_TEXELS * index) + i).xyz);
}
