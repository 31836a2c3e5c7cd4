// The instances of trees: robot instances first, then the world's.
struct Instance
{
  uint root;   // node
  float slack; // the true surface lies at most this much outside of the triangles, metres
  vec3 core;   // half edge lengths of a box around the shape's origin that lies within its solid; negative: there is none
};

layout(std430, binding = BINDING_GEOMETRIES) readonly buffer Instances { uvec4 instances[]; };  // root and slack; core

Instance fetchInstance(uint index)
{
  const uvec4 a = instances[2u * index];
  return Instance(a.x, uintBitsToFloat(a.y), uintBitsToFloat(instances[2u * index + 1u].xyz));
}

uint packPair(uint robot, uint other)
{
  return (robot << PAIR_OTHER_BITS) | other;
}

uint pairRobot(uint pair)
{
  return pair >> PAIR_OTHER_BITS;
}

uint pairOther(uint pair)
{
  return pair & ((1u << PAIR_OTHER_BITS) - 1u);
}
