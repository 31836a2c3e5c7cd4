// The digit that a pass of the radix sort uses, from the least significant one on (Knuth, "The Art of Computer
// Programming", vol. 3, 5.2.5). The three parallel steps are those of M. Zagha and G. E. Blelloch, "Radix Sort for
// Vector Multiprocessors", 1991.
layout(location = LOCATION_KEY_COUNT) uniform uint key_count;
layout(location = LOCATION_SHIFT) uniform uint shift;
layout(location = LOCATION_BY_MESH) uniform uint by_mesh;  // 1: sort by the primitive's mesh instead of the key
layout(std430, binding = BINDING_KEYS_IN) readonly buffer KeysIn { uvec2 keys_in[]; };
layout(std430, binding = BINDING_MESH_OF) readonly buffer MeshOf { uint mesh_of[]; };

uint digitOf(uvec2 key)
{
  const uint value = by_mesh != 0u ? mesh_of[key.y] : key.x;
  return (value >> shift) & (RADIX_SIZE - 1u);
}
