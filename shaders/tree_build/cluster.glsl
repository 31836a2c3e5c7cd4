// A cluster of the bottom-up build: a subtree that has no parent yet. Two uvec4: the corners of its box as float bits
// (metres, in the mesh's frame), its reference and its number of triangles.
struct Cluster
{
  vec3 low;
  vec3 high;
  uint reference;  // count 1: a primitive; more: the number of the pair that holds its children
  uint count;      // number of triangles
  bool opened;     // true if opening it is cheaper than testing all its triangles
};

#define OPENED_BIT 0x80000000u

Cluster unpackCluster(uvec4 a, uvec4 b)
{
  return Cluster(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), a.w, b.w & ~OPENED_BIT, (b.w & OPENED_BIT) != 0u);
}

uvec4 packLow(Cluster c)
{
  return uvec4(floatBitsToUint(c.low), c.reference);
}

uvec4 packHigh(Cluster c)
{
  return uvec4(floatBitsToUint(c.high), c.count | (c.opened ? OPENED_BIT : 0u));
}

float halfArea(vec3 extent)
{
  return extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
}
