// The instances of trees: robot instances first, then the world's.
layout(location = 0) uniform uint state_count;
layout(location = 1) uniform uint robot_count;
layout(std430, binding = BINDING_GEOMETRIES) readonly buffer Geometries { uvec2 geometries[]; };  // root, slack

// Invocations of the broad phase go through all states for one robot instance before the next one: what hits early in
// the lists then spares its state the rest, and a state's pairs do not wait side by side.
uint robotOf(uint invocation)
{
  return invocation / state_count;
}

uint stateOf(uint invocation)
{
  return invocation % state_count;
}

uint poseIndex(uint state, uint robot)
{
  return state * robot_count + robot;
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
