// The instances of trees: robot instances first, then the world's.
layout(location = 0) uniform uint state_count;
layout(location = 1) uniform uint robot_count;
layout(std430, binding = BINDING_GEOMETRIES) readonly buffer Geometries { uvec2 geometries[]; };  // root, slack

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
