// A cluster of the bottom-up build: a subtree that has no parent yet. Two uvec4: the box's corners as float bits,
// what it refers to and how many triangles it holds.
struct Cluster
{
  vec3 low;
  vec3 high;
  uint reference;  // count 1: a primitive; more: the number of the pair that its children lie in
  uint count;
  bool opened;     // whether it is cheaper to open it than to test all its triangles
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
